// The picture: path, envelope, work zero and tool, in work coordinates. Draws only when something has changed.

import * as three from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { PathLines } from './path_lines';
import type { Strokes } from './strokes';

export type View = 'iso' | 'top' | 'front' | 'side';
export interface Box {
  min: number[];
  max: number[];
}

const quiet_ms = 250;
const fewSegments = 50_000;
const manySegments = 400_000;

const directions: Record<View, [number, number, number]> = {
  iso: [-0.6, -1, 0.75],
  top: [0, -0.0001, 1],
  front: [0, -1, 0.0001],
  side: [1, 0, 0.0001],
};

function colourOf(element: Element, name: string): three.Color {
  return new three.Color(getComputedStyle(element).getPropertyValue(name).trim() || '#888');
}

export class Scene {
  private readonly renderer: three.WebGLRenderer;
  private readonly scene = new three.Scene();
  private readonly camera = new three.OrthographicCamera(-1, 1, 1, -1, -10000, 10000);
  private readonly controls: OrbitControls;
  readonly path = new PathLines();
  private readonly tool: three.Mesh;
  private readonly zero = new three.AxesHelper(12);
  private envelope: three.LineSegments | undefined;
  private size = { width: 1, height: 1 };
  private isDue = false;
  private isCalm = false;
  private isTurned = false;
  private refining: ReturnType<typeof setTimeout> | undefined;
  private bounds = new three.Box3();

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new three.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.draw());
    this.controls.addEventListener('start', () => (this.isTurned = true));
    this.controls.addEventListener('end', () => ((this.isTurned = false), this.draw()));
    const cone = new three.ConeGeometry(3, 10, 24).rotateX(-Math.PI / 2).translate(0, 0, 5);
    this.tool = new three.Mesh(cone, new three.MeshBasicMaterial({ transparent: true, opacity: 0.9 }));
    this.tool.visible = false;
    this.scene.add(this.path.group, this.tool, this.zero);
    this.look('iso');
  }

  setColours(): void {
    this.path.setColours((name) => colourOf(this.canvas, name));
    (this.tool.material as three.MeshBasicMaterial).color = colourOf(this.canvas, '--path-now');
    this.zero.setColors(colourOf(this.canvas, '--x'), colourOf(this.canvas, '--y'), colourOf(this.canvas, '--z'));
    if (this.envelope)
      (this.envelope.material as three.LineBasicMaterial).color = colourOf(this.canvas, '--line-strong');
    this.draw();
  }

  add(strokes: Strokes): void {
    this.path.add(strokes);
    const [a, b, c, d, e, f] = strokes.bounds as [number, number, number, number, number, number];
    if (a <= d) this.bounds.union(new three.Box3(new three.Vector3(a, b, c), new three.Vector3(d, e, f)));
    this.draw();
  }

  clear(): void {
    this.path.clear();
    this.bounds.makeEmpty();
    this.draw();
  }

  setEnvelope(box: Box | undefined): void {
    if (this.envelope) this.scene.remove(this.envelope);
    this.envelope?.geometry.dispose();
    this.envelope = undefined;
    if (box) {
      const [min, max] = [new three.Vector3(...box.min), new three.Vector3(...box.max)];
      const size = max.clone().sub(min);
      const edges = new three.EdgesGeometry(new three.BoxGeometry(size.x, size.y, size.z));
      this.envelope = new three.LineSegments(
        edges,
        new three.LineBasicMaterial({ color: colourOf(this.canvas, '--line-strong') }),
      );
      this.envelope.position.copy(min.clone().add(max).multiplyScalar(0.5));
      this.scene.add(this.envelope);
    }
    this.draw();
  }

  setTool(place: number[] | undefined, isCertain: boolean): void {
    this.tool.visible = !!place;
    if (place) this.tool.position.set(place[0] ?? 0, place[1] ?? 0, place[2] ?? 0);
    (this.tool.material as three.MeshBasicMaterial).wireframe = !isCertain;
    this.draw();
  }

  look(view: View): void {
    const box = this.framed();
    const centre = box.getCenter(new three.Vector3());
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).add(new three.Vector3(...directions[view]).multiplyScalar(1000));
    this.camera.lookAt(centre);
    this.camera.updateMatrixWorld();
    const inSight = box.clone().applyMatrix4(this.camera.matrixWorldInverse).getSize(new three.Vector3());
    const zoom = Math.min(this.size.width / (inSight.x || 1), this.size.height / (inSight.y || 1)) * 0.84;
    this.camera.zoom = Number.isFinite(zoom) && zoom > 0 ? zoom : 1;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  private framed(): three.Box3 {
    if (!this.bounds.isEmpty()) return this.bounds;
    if (this.envelope) return new three.Box3().setFromObject(this.envelope);
    return new three.Box3(new three.Vector3(0, 0, 0), new three.Vector3(100, 100, 10));
  }

  resize(width: number, height: number): void {
    if (width < 1 || height < 1) return;
    this.size = { width, height };
    Object.assign(this.camera, { left: -width / 2, right: width / 2, top: height / 2, bottom: -height / 2 });
    this.camera.updateProjectionMatrix();
    this.renderer.setSize(width, height, false);
    this.draw();
  }

  /** The line of the program under a point of the canvas; 0 where there is none. */
  pick(x: number, y: number): number {
    const ray = new three.Raycaster();
    ray.setFromCamera(new three.Vector2((x / this.size.width) * 2 - 1, 1 - (y / this.size.height) * 2), this.camera);
    return this.path.pick(ray, 7 / this.camera.zoom);
  }

  draw(): void {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      const pixel = 1 / this.camera.zoom;
      this.tool.scale.setScalar(pixel * 3.2);
      this.zero.scale.setScalar(pixel * 4);
      this.path.chooseLevel(pixel, this.sight(), this.hurries() ? fewSegments : manySegments);
      this.renderer.render(this.scene, this.camera);
    });
  }

  /** Picture follows picture: coarse ones now, a fine one when it is quiet. */
  private hurries(): boolean {
    clearTimeout(this.refining);
    const isCalm = this.isCalm && !this.isTurned;
    this.isCalm = false;
    if (!isCalm)
      this.refining = setTimeout(() => {
        this.isCalm = true;
        this.draw();
      }, quiet_ms);
    return !isCalm;
  }

  private sight(): three.Frustum {
    const { projectionMatrix, matrixWorldInverse } = this.camera;
    return new three.Frustum().setFromProjectionMatrix(projectionMatrix.clone().multiply(matrixWorldInverse));
  }

  dispose(): void {
    clearTimeout(this.refining);
    this.controls.dispose();
    this.path.clear();
    this.renderer.dispose();
  }
}
