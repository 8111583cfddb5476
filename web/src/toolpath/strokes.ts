// From a chunk to what a graphics card draws: vertices, and pairs of them that are visible motions. Arcs become chords.

import type { Arc, Chunk } from './decoder';

export interface Strokes {
  level: number;
  bounds: number[];
  positions: Float32Array;
  lines: Float32Array;
  kinds: Float32Array;
  indices: Uint32Array;
  firstLine: number;
  lastLine: number;
}

const chordError_mm = 0.02;
const mostChords = 180;
const lastMoving = 5;
const planes = [
  [0, 1, 2],
  [2, 0, 1],
  [1, 2, 0],
] as const;

const isCut = (kind: number) => kind >= 1 && kind <= 3;

/** A motion with an unknown place at an end is not drawn; a cut is known from where it begins. */
export function isDrawn(kind: number, unknownBefore: number): boolean {
  const motion = kind & 15;
  if (motion > lastMoving) return false;
  return (((kind >> 4) & 7) | (isCut(motion) ? 0 : unknownBefore)) === 0;
}

export function chordsOf(from: number[], to: number[], arc: Arc, clockwise: boolean): number[] {
  const [u, v, w] = planes[arc.plane] ?? planes[0];
  const at = (point: number[], axis: number) => point[axis] ?? 0;
  const centre = [at(from, u) + arc.centre[0], at(from, v) + arc.centre[1]] as const;
  const first = Math.atan2(at(from, v) - centre[1], at(from, u) - centre[0]);
  const last = Math.atan2(at(to, v) - centre[1], at(to, u) - centre[0]);
  const r0 = Math.hypot(arc.centre[0], arc.centre[1]);
  const r1 = Math.hypot(at(to, u) - centre[0], at(to, v) - centre[1]);
  let sweep = last - first;
  if (clockwise && sweep >= -1e-6) sweep -= 2 * Math.PI;
  if (!clockwise && sweep <= 1e-6) sweep += 2 * Math.PI;
  sweep += (clockwise ? -1 : 1) * 2 * Math.PI * Math.max(0, arc.turns - 1);
  const fine = Math.acos(Math.max(-1, 1 - chordError_mm / Math.max(r0, r1, chordError_mm)));
  const chords = Math.max(2, Math.min(mostChords * arc.turns, Math.ceil(Math.abs(sweep) / (2 * fine))));
  const points: number[] = [];
  for (let step = 1; step < chords; step++) {
    const share = step / chords;
    const angle = first + sweep * share;
    const radius = r0 + (r1 - r0) * share;
    const point = [0, 0, 0];
    point[u] = centre[0] + radius * Math.cos(angle);
    point[v] = centre[1] + radius * Math.sin(angle);
    point[w] = at(from, w) + (at(to, w) - at(from, w)) * share;
    points.push(...point);
  }
  return points;
}

export function strokesOf(chunk: Chunk): Strokes {
  const { places, lines, kinds, arcs } = chunk;
  const points: number[] = [...chunk.start];
  const ofLine: number[] = [chunk.startLine];
  const ofKind: number[] = [0];
  const indices: number[] = [];
  let nextArc = 0;
  let unknown = chunk.startUnknown;
  let from: number[] = [...chunk.start];
  for (let at = 0; at < lines.length; at++) {
    const to = [places[at * 3] ?? 0, places[at * 3 + 1] ?? 0, places[at * 3 + 2] ?? 0];
    const kind = kinds[at] ?? 0;
    const arc = arcs[nextArc]?.vertex === at ? arcs[nextArc++] : undefined;
    const drawn = isDrawn(kind, unknown);
    const path = drawn && arc ? chordsOf(from, to, arc, (kind & 15) === 2) : [];
    path.push(...to);
    for (let p = 0; p < path.length; p += 3) {
      if (drawn) indices.push(ofLine.length - 1, ofLine.length);
      points.push(path[p] ?? 0, path[p + 1] ?? 0, path[p + 2] ?? 0);
      ofLine.push(lines[at] ?? 0);
      ofKind.push(kind & 15);
    }
    unknown = (kind >> 4) & 7;
    from = to;
  }
  return {
    level: chunk.level,
    bounds: chunk.bounds,
    positions: new Float32Array(points),
    lines: new Float32Array(ofLine),
    kinds: new Float32Array(ofKind),
    indices: new Uint32Array(indices),
    firstLine: lines[0] ?? chunk.startLine,
    lastLine: lines[lines.length - 1] ?? chunk.startLine,
  };
}
