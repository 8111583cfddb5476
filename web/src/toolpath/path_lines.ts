// The path as chunks of line segments, level by level; of a long program only the level that the eye can tell is drawn.

import * as three from 'three';
import { fragmentShader, vertexShader } from './shaders';
import type { Strokes } from './strokes';

/** Above this many segments levels stand for what is smaller than a pixel. */
const manySegments = 40_000;
/** Above this many it is not kept at all: the finest level that was thinned out stands for it. */
const mostKept = 4_000_000;
const tried_ms = 30;

interface Part {
  lines: three.LineSegments;
  level: number;
  first: number;
  last: number;
  segments: number;
}

/** Known from the server, so that nobody has to go over all vertices for it. */
function sphereOf(bounds: number[]): three.Sphere {
  const [a, b, c, d, e, f] = bounds as [number, number, number, number, number, number];
  if (a > d) return new three.Sphere(new three.Vector3(), Infinity);
  return new three.Box3(new three.Vector3(a, b, c), new three.Vector3(d, e, f)).getBoundingSphere(new three.Sphere());
}

export class PathLines {
  readonly group = new three.Group();
  tolerances: number[] = [];
  private parts: Part[] = [];
  private segments: number[] = [];
  private readonly material = new three.ShaderMaterial({
    vertexShader,
    fragmentShader,
    glslVersion: three.GLSL3,
    transparent: true,
    uniforms: {
      doneBefore: { value: 0 },
      nowUntil: { value: 0 },
      marked: { value: 0 },
      rapidColour: { value: new three.Color() },
      cutColour: { value: new three.Color() },
      doneColour: { value: new three.Color() },
      nowColour: { value: new three.Color() },
      markColour: { value: new three.Color() },
    },
  });

  add(strokes: Strokes): void {
    const segments = strokes.indices.length / 2;
    this.segments[strokes.level] = (this.segments[strokes.level] ?? 0) + segments;
    if (strokes.level === 0 && (this.segments[0] ?? 0) > mostKept && this.tolerances.length > 0) return this.forget(0);
    const geometry = new three.BufferGeometry();
    geometry.setAttribute('position', new three.BufferAttribute(strokes.positions, 3));
    geometry.setAttribute('line', new three.BufferAttribute(strokes.lines, 1));
    geometry.setAttribute('kind', new three.BufferAttribute(strokes.kinds, 1));
    geometry.setIndex(new three.BufferAttribute(strokes.indices, 1));
    geometry.boundingSphere = sphereOf(strokes.bounds);
    const lines = new three.LineSegments(geometry, this.material);
    lines.visible = strokes.level === 0;
    this.group.add(lines);
    const { level, firstLine: first, lastLine: last } = strokes;
    this.parts.push({ lines, level, first, last, segments });
  }

  /** The coarsest level whose error is below a pixel, or coarser yet where more than `most` segments were in sight. */
  chooseLevel(pixel_mm: number, sight: three.Frustum, most: number): void {
    const all = this.segments[0] ?? 0;
    let level = 0;
    if (all > manySegments)
      this.tolerances.forEach((tolerance, at) => {
        if (tolerance <= pixel_mm && this.has(at + 1)) level = at + 1;
      });
    if (all > mostKept && level === 0 && this.has(1)) level = 1;
    while (this.has(level + 1) && this.inSight(level, sight) > most) level++;
    for (const part of this.parts) part.lines.visible = part.level === level;
  }

  private has(level: number): boolean {
    return (this.segments[level] ?? 0) > 0;
  }

  private inSight(level: number, sight: three.Frustum): number {
    return this.parts
      .filter(({ level: one, lines }) => one === level && sight.intersectsObject(lines))
      .reduce((sum, part) => sum + part.segments, 0);
  }

  setProgress(doneBefore: number, nowUntil: number, marked: number): void {
    Object.entries({ doneBefore, nowUntil, marked }).forEach(([name, value]) => this.uniform(name, value));
  }

  setColours(colour: (name: string) => three.Color): void {
    for (const name of ['rapid', 'cut', 'done', 'now', 'mark'])
      this.uniform(`${name}Colour`, colour(`--path-${name}`).convertLinearToSRGB());
  }

  /** Where the tool is when `line` ends. */
  endOf(line: number): number[] | undefined {
    for (const part of this.parts) {
      if (part.level !== 0 || line < part.first || line > part.last) continue;
      const lines = part.lines.geometry.getAttribute('line').array;
      let low = 0;
      let high = lines.length;
      while (low < high) {
        const middle = (low + high) >> 1;
        if ((lines[middle] ?? 0) <= line) low = middle + 1;
        else high = middle;
      }
      const places = part.lines.geometry.getAttribute('position').array;
      const at = Math.max(0, low - 1) * 3;
      return [places[at] ?? 0, places[at + 1] ?? 0, places[at + 2] ?? 0];
    }
    return undefined;
  }

  pick(ray: three.Raycaster, reach_mm: number): number {
    ray.params.Line = { threshold: reach_mm };
    const until = performance.now() + tried_ms;
    let best: { line: number; off: number } | undefined;
    for (const part of this.parts) {
      if (!part.lines.visible || performance.now() > until) continue;
      for (const hit of ray.intersectObject(part.lines, false)) {
        const end = part.lines.geometry.getIndex()?.getX((hit.index ?? 0) + 1) ?? 0;
        const off = hit.distanceToRay ?? ray.ray.distanceToPoint(hit.point);
        if (!best || off < best.off) best = { line: part.lines.geometry.getAttribute('line').getX(end), off };
      }
    }
    return best?.line ?? 0;
  }

  clear(): void {
    for (const part of this.parts) part.lines.geometry.dispose();
    this.group.clear();
    this.parts = [];
    this.segments = [];
    this.tolerances = [];
  }

  private forget(level: number): void {
    for (const part of this.parts.filter((one) => one.level === level)) {
      this.group.remove(part.lines);
      part.lines.geometry.dispose();
    }
    this.parts = this.parts.filter((one) => one.level !== level);
  }

  private uniform(name: string, value: number | three.Color): void {
    const uniform = this.material.uniforms[name];
    if (uniform) uniform.value = value;
  }
}
