// Reads a toolpath as docs/toolpath_format.md describes it, however the stream was cut.

export interface Run {
  first: number;
  feed: number;
  speed: number;
  tool: number;
  operation: number;
}

export interface Arc {
  vertex: number;
  centre: [number, number];
  turns: number;
  plane: number;
}

export interface Chunk {
  level: number;
  begin_s: number;
  start: [number, number, number];
  startLine: number;
  startUnknown: number;
  bounds: number[];
  places: Float32Array;
  times: Float32Array;
  lines: Uint32Array;
  kinds: Uint8Array;
  runs: Run[];
  arcs: Arc[];
}

export type Section =
  | { tag: 'KTP1'; tolerances: number[] }
  | { tag: 'CHNK'; chunk: Chunk }
  | { tag: 'NAME'; names: string[] }
  | { tag: 'TIME'; path_s: Float64Array; machine_s: Float64Array }
  | { tag: 'DONE'; vertices: number; seconds: number; refused: number; bounds: number[] };

export class FormatError extends Error {}

const headBytes = 16;
const chunkHead = 72;
const mostSection = 1 << 30;
const upTo4 = (n: number) => (n + 3) & ~3;

/** Takes bytes as they come, gives sections as they are complete. */
export class SectionReader {
  private head = new Uint8Array(headBytes);
  private have = 0;
  private body: Uint8Array | null = null;
  private tag = '';
  finished = false;

  push(bytes: Uint8Array): Section[] {
    const found: Section[] = [];
    let at = 0;
    while (at < bytes.length) {
      const target = this.body ?? this.head;
      const taken = Math.min(target.length - this.have, bytes.length - at);
      target.set(bytes.subarray(at, at + taken), this.have);
      at += taken;
      this.have += taken;
      if (this.have < target.length) break;
      if (!this.body) this.begin();
      if (this.body && this.have === this.body.length) this.finish(this.body, found);
    }
    return found;
  }

  private begin(): void {
    const view = new DataView(this.head.buffer);
    const length = view.getUint32(8, true) + view.getUint32(12, true) * 2 ** 32;
    if (length > mostSection || length % 8 !== 0) throw new FormatError('section length');
    this.tag = String.fromCharCode(...this.head.subarray(0, 4));
    this.body = new Uint8Array(length);
    this.have = 0;
  }

  private finish(body: Uint8Array, found: Section[]): void {
    const section = decodeSection(this.tag, body.buffer as ArrayBuffer);
    if (section) found.push(section);
    if (section?.tag === 'DONE') this.finished = true;
    this.body = null;
    this.have = 0;
  }
}

/** Undefined for a tag that nobody knows. */
export function decodeSection(tag: string, body: ArrayBuffer): Section | undefined {
  const view = new DataView(body);
  if (tag === 'CHNK') return { tag, chunk: decodeChunk(body, view) };
  if (tag === 'KTP1') {
    const count = view.getUint32(0, true);
    return { tag, tolerances: Array.from({ length: count }, (_, at) => view.getFloat32(24 + at * 4, true)) };
  }
  if (tag === 'NAME') return { tag, names: decodeNames(view) };
  if (tag === 'TIME') {
    const pairs = new Float64Array(body, 8, Number(view.getBigUint64(0, true)) * 2);
    return { tag, path_s: pairs.filter((_, at) => at % 2 === 0), machine_s: pairs.filter((_, at) => at % 2 === 1) };
  }
  if (tag !== 'DONE') return undefined;
  return {
    tag,
    vertices: Number(view.getBigUint64(0, true)),
    seconds: view.getFloat64(8, true),
    refused: view.getUint32(16, true),
    bounds: [0, 1, 2, 3, 4, 5].map((at) => view.getFloat32(24 + at * 4, true)),
  };
}

function decodeNames(view: DataView): string[] {
  const names: string[] = [];
  const text = new TextDecoder();
  let at = 4;
  for (let left = view.getUint32(0, true); left > 0; left--) {
    const length = view.getUint32(at, true);
    names.push(text.decode(new Uint8Array(view.buffer, view.byteOffset + at + 4, length)));
    at += 4 + upTo4(length);
  }
  return names;
}

function decodeChunk(body: ArrayBuffer, view: DataView): Chunk {
  const [n, r, a] = [view.getUint32(4, true), view.getUint32(8, true), view.getUint32(12, true)];
  const kindsAt = chunkHead + n * 20;
  const runsAt = kindsAt + upTo4(n);
  const arcsAt = runsAt + r * 16;
  if (arcsAt + a * 16 > body.byteLength) throw new FormatError('chunk is shorter than it says');
  return {
    level: view.getUint32(0, true),
    begin_s: view.getFloat64(16, true),
    start: [view.getFloat32(24, true), view.getFloat32(28, true), view.getFloat32(32, true)],
    startLine: view.getUint32(36, true),
    startUnknown: view.getUint8(44),
    bounds: [0, 1, 2, 3, 4, 5].map((at) => view.getFloat32(48 + at * 4, true)),
    places: new Float32Array(body, chunkHead, n * 3),
    times: new Float32Array(body, chunkHead + n * 12, n),
    lines: new Uint32Array(body, chunkHead + n * 16, n),
    kinds: new Uint8Array(body, kindsAt, n),
    runs: Array.from({ length: r }, (_, at) => decodeRun(view, runsAt + at * 16)),
    arcs: Array.from({ length: a }, (_, at) => decodeArc(view, arcsAt + at * 16)),
  };
}

const decodeRun = (view: DataView, at: number): Run => ({
  first: view.getUint32(at, true),
  feed: view.getFloat32(at + 4, true),
  speed: view.getFloat32(at + 8, true),
  tool: view.getUint16(at + 12, true),
  operation: view.getUint16(at + 14, true),
});

const decodeArc = (view: DataView, at: number): Arc => ({
  vertex: view.getUint32(at, true),
  centre: [view.getFloat32(at + 4, true), view.getFloat32(at + 8, true)],
  turns: view.getUint16(at + 12, true),
  plane: view.getUint8(at + 14),
});
