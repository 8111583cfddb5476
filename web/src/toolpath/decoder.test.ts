import fc from 'fast-check';
import { describe, expect, it } from 'vitest';
import { FormatError, SectionReader, type Section } from './decoder';
import { chordsOf, strokesOf } from './strokes';

/** Bytes by hand, as docs/toolpath_format.md lays them out. */
class Bytes {
  private parts: number[] = [];
  private put(size: number, set: (view: DataView) => void): this {
    const view = new DataView(new ArrayBuffer(size));
    set(view);
    this.parts.push(...new Uint8Array(view.buffer));
    return this;
  }
  u8 = (...all: number[]) => all.reduce<this>((me, n) => me.put(1, (v) => v.setUint8(0, n)), this);
  u16 = (...all: number[]) => all.reduce<this>((me, n) => me.put(2, (v) => v.setUint16(0, n, true)), this);
  u32 = (...all: number[]) => all.reduce<this>((me, n) => me.put(4, (v) => v.setUint32(0, n, true)), this);
  f32 = (...all: number[]) => all.reduce<this>((me, n) => me.put(4, (v) => v.setFloat32(0, n, true)), this);
  f64 = (...all: number[]) => all.reduce<this>((me, n) => me.put(8, (v) => v.setFloat64(0, n, true)), this);
  u64 = (n: number) => this.put(8, (v) => v.setBigUint64(0, BigInt(n), true));
  pad = (to: number) => {
    while (this.parts.length % to !== 0) this.parts.push(0);
    return this;
  };
  get all() {
    return this.parts;
  }
}

function section(tag: string, body: Bytes): number[] {
  body.pad(8);
  const head = new Bytes().u8(...[...tag].map((letter) => letter.charCodeAt(0))).u32(0);
  return [...head.u64(body.all.length).all, ...body.all];
}

const chunk = new Bytes()
  .u32(0, 3, 1, 1)
  .f64(2.5)
  .f32(0, 0, 5)
  .u32(4)
  .u16(1, 0)
  .u8(4, 0, 0, 0)
  .f32(0, 0, 0, 10, 10, 5)
  .f32(10, 0, 5, 10, 0, 0, 0, 10, 0)
  .f32(0.5, 1, 2)
  .u32(6, 7, 8)
  .u8(0, 1, 3)
  .pad(4)
  .u32(0)
  .f32(600, 1000)
  .u16(1, 0)
  .u32(2)
  .f32(-10, 0)
  .u16(1)
  .u8(0, 0);

const file = [
  ...section('KTP1', new Bytes().u32(2, 0).f64(0, 0).f32(0.1, 1)),
  ...section('CHNK', chunk),
  ...section('LATR', new Bytes().u32(1, 2)),
  ...section('NAME', new Bytes().u32(2, 0, 4).u8(82, 105, 110, 103)),
  ...section('TIME', new Bytes().u64(2).f64(1, 1.5, 2, 3)),
  ...section('DONE', new Bytes().u64(3).f64(4.5).u32(1, 0).f32(0, 0, 0, 10, 10, 5)),
];

function readIn(cuts: number[]): Section[] {
  const reader = new SectionReader();
  const found: Section[] = [];
  let from = 0;
  for (const cut of [...cuts, file.length]) {
    found.push(...reader.push(new Uint8Array(file.slice(from, cut))));
    from = cut;
  }
  expect(reader.finished).toBe(true);
  return found;
}

describe('a stream of sections', () => {
  it('gives what is in it, and passes over tags that it does not know', () => {
    const [head, path, names, times, done] = readIn([]);
    expect(head).toEqual({ tag: 'KTP1', tolerances: [expect.closeTo(0.1), 1] });
    expect(path).toMatchObject({
      tag: 'CHNK',
      chunk: { level: 0, begin_s: 2.5, start: [0, 0, 5], startLine: 4, startUnknown: 4 },
    });
    if (path?.tag !== 'CHNK') throw new Error();
    expect([...path.chunk.places]).toEqual([10, 0, 5, 10, 0, 0, 0, 10, 0]);
    expect([...path.chunk.lines]).toEqual([6, 7, 8]);
    expect(path.chunk.runs).toEqual([{ first: 0, feed: 600, speed: 1000, tool: 1, operation: 0 }]);
    expect(path.chunk.arcs).toEqual([{ vertex: 2, centre: [-10, 0], turns: 1, plane: 0 }]);
    expect(names).toEqual({ tag: 'NAME', names: ['', 'Ring'] });
    expect(times).toMatchObject({ path_s: new Float64Array([1, 2]), machine_s: new Float64Array([1.5, 3]) });
    expect(done).toMatchObject({ vertices: 3, seconds: 4.5, refused: 1, bounds: [0, 0, 0, 10, 10, 5] });
  });

  it('does not mind how it was cut', () => {
    const whole = JSON.stringify(readIn([]));
    fc.assert(
      fc.property(fc.array(fc.integer({ min: 0, max: file.length }), { maxLength: 20 }), (cuts) => {
        expect(JSON.stringify(readIn(cuts.sort((a, b) => a - b)))).toBe(whole);
      }),
    );
  });

  it('refuses lengths that cannot be', () => {
    expect(() =>
      new SectionReader().push(new Uint8Array([75, 84, 80, 49, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0])),
    ).toThrow(FormatError);
  });
});

describe('what is drawn', () => {
  it('no motion from an unknown place, but a cut; arcs as chords on their circle', () => {
    const [, path] = readIn([]);
    if (path?.tag !== 'CHNK') throw new Error();
    const { indices, lines, positions } = strokesOf(path.chunk);
    expect(lines[indices[1] ?? 0]).toBe(7);
    expect(indices.length).toBeGreaterThan(20);
    for (let at = 3; at < lines.length; at++)
      expect(Math.hypot(positions[at * 3] ?? 0, positions[at * 3 + 1] ?? 0)).toBeCloseTo(10, 3);
  });

  it('a full circle goes round, either way', () => {
    const arc = { vertex: 0, centre: [5, 0] as [number, number], turns: 1, plane: 0 };
    for (const clockwise of [true, false]) {
      const points = chordsOf([0, 0, 0], [0, 0, -2], arc, clockwise);
      const half = Math.floor(points.length / 6) * 3;
      expect(Math.abs((points[half] ?? 0) - 10)).toBeLessThan(0.5);
      expect(Math.sign(points[1] ?? 0)).toBe(clockwise ? 1 : -1);
    }
  });
});
