// The solids of a world, drawn by three.js. The page imports this file when the first world is shown in three
// dimensions.

import {
  ArrowHelper,
  DoubleSide,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Plane,
  Spherical,
  Vector3,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { SolidView } from "../protocol";
import type { PlanPoint } from "./planFrame";
import { WebGLStage } from "../plots/scenes/webGLStage";
import { geometryOf } from "./geometry";
import type { Point3 } from "../model/sceneView";

// What a ray through a pixel meets first.
export type SolidHit = { solid: SolidView; index: number; point: Point3 };

// The share of the light from all sides.
const AMBIENT = 0.55;
const ANGLE = 35;
// Where the camera is at first: from behind the robot and from its right, so that left is left.
const AZIMUTH = (-62 * Math.PI) / 180;
const ELEVATION = (32 * Math.PI) / 180;
// Height of the middle of the view, as a share of the diagonal of the floor.
const ABOVE = 0.1;
// Numbers of a pose.
const POSE = 12;
const MARKED = 0x404040;
const PULL = 0xb3261e;

export class SolidStage extends WebGLStage {
  readonly controls: OrbitControls;
  private arrow = new ArrowHelper(new Vector3(1, 0, 0), new Vector3(), 0.1, PULL);
  private meshes: Mesh[] = [];
  private solids: SolidView[] = [];
  private followed: Vector3 | null = null;
  // Whether the view was turned or has followed a body, and the border and aspect that it shows as a whole
  // until then.
  private turned = false;
  private framed = "";

  constructor(
    canvas: HTMLCanvasElement,
    private changed: () => void,
  ) {
    super(canvas, new PerspectiveCamera(ANGLE, 1, 0.01, 100), AMBIENT, 2);
    this.arrow.visible = false;
    for (const part of [this.arrow.line, this.arrow.cone]) {
      // in front of what it starts in
      Object.assign(part.material, { depthTest: false, transparent: true });
      part.renderOrder = 1;
    }
    this.scene.add(this.arrow);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.minDistance = 0.05;
    this.controls.maxDistance = 50;
    this.controls.addEventListener("change", changed);
    this.controls.addEventListener("start", () => {
      this.turned = true;
    });
  }

  // Show the whole floor within a border, and what is above it, on a canvas of an aspect, unless the user has
  // chosen a view: a panel gets its size after it was made, and another one with its neighbours.
  frame([x0, y0, x1, y1]: [number, number, number, number], aspect: number): void {
    const wanted = [x0, y0, x1, y1, aspect].join();
    if (this.turned || wanted === this.framed) {
      return;
    }
    this.framed = wanted;
    const across = Math.hypot(x1 - x0, y1 - y0);
    const half = Math.tan((ANGLE / 2) * (Math.PI / 180)) * Math.min(1, aspect);
    const distance = (0.6 * across) / half;
    const target = new Vector3((x0 + x1) / 2, (y0 + y1) / 2, ABOVE * across);
    this.controls.target.copy(target);
    this.camera.position.set(
      target.x + distance * Math.cos(ELEVATION) * Math.cos(AZIMUTH),
      target.y + distance * Math.cos(ELEVATION) * Math.sin(AZIMUTH),
      target.z + distance * Math.sin(ELEVATION),
    );
    this.controls.update();
  }

  show(solids: SolidView[]): void {
    if (solids === this.solids) {
      return;
    }
    this.clear();
    this.solids = solids;
    this.meshes = solids.map((solid) => {
      const [r, g, b, opacity = 1] = solid.color as [number, number, number, number];
      const material = new MeshLambertMaterial({ transparent: opacity < 1, opacity, side: DoubleSide });
      material.color.setRGB(r, g, b);
      const mesh = new Mesh(geometryOf(solid), material);
      mesh.matrixAutoUpdate = false;
      mesh.visible = false; // until its pose arrives
      this.scene.add(mesh);
      return mesh;
    });
  }

  // Move the solids to their poses; those of other solids are not taken.
  place(poses: Float32Array): void {
    if (poses.length !== POSE * this.meshes.length) {
      return;
    }
    this.meshes.forEach((mesh, n) => {
      const [x, y, z, a, b, c, d, e, f, g, h, i] = poses.subarray(POSE * n, POSE * (n + 1)) as unknown as [
        ...[number, number, number, number, number, number],
        ...[number, number, number, number, number, number],
      ];
      mesh.matrix.set(a, b, c, x, d, e, f, y, g, h, i, z, 0, 0, 0, 1);
      mesh.matrixWorldNeedsUpdate = true;
      mesh.visible = true;
    });
  }

  // Keep the view at a place that moves; null: the view stays where it is.
  follow(place: PlanPoint | null): void {
    const now = place === null ? null : new Vector3(place.x, place.y, 0);
    if (now !== null && this.followed !== null) {
      const way = now.clone().sub(this.followed);
      if (way.length() > 0) {
        this.turned = true;
        this.camera.position.add(way);
        this.controls.target.add(way);
        this.controls.update();
      }
    }
    this.followed = now;
  }

  // Turn by angles in degrees, and come nearer by a factor.
  turn(azimuth: number, elevation: number, nearer = 1): void {
    this.turned = true;
    const { target } = this.controls;
    // of three.js, whose angles are around y
    const upright = new Matrix4().makeRotationX(-Math.PI / 2);
    const offset = this.camera.position.clone().sub(target).applyMatrix4(upright);
    const at = new Spherical().setFromVector3(offset);
    at.theta += (azimuth * Math.PI) / 180;
    at.phi = Math.min(Math.PI - 0.01, Math.max(0.01, at.phi - (elevation * Math.PI) / 180));
    at.radius = Math.min(this.controls.maxDistance, Math.max(this.controls.minDistance, at.radius / nearer));
    this.camera.position.setFromSpherical(at).applyMatrix4(upright.invert()).add(target);
    this.controls.update();
  }

  mark(chosen: (solid: SolidView) => boolean): void {
    this.meshes.forEach(({ material }, n) => {
      const solid = this.solids[n];
      const marked = solid !== undefined && chosen(solid);
      (material as MeshLambertMaterial).emissive.set(marked ? MARKED : 0);
    });
    this.changed();
  }

  // An arrow between two points; null: none.
  point(ends: [Point3, Point3] | null): void {
    this.arrow.visible = ends !== null;
    if (ends !== null) {
      const [from, to] = ends.map((end) => new Vector3(...end)) as [Vector3, Vector3];
      const way = to.clone().sub(from);
      const length = Math.max(1e-4, way.length());
      this.arrow.position.copy(from);
      this.arrow.setDirection(way.normalize());
      this.arrow.setLength(length, Math.min(0.05, length / 3), Math.min(0.03, length / 5));
    }
  }

  // What lies under a pixel of the canvas.
  hit(x: number, y: number): SolidHit | null {
    const ray = this.ray(x, y);
    const seen = this.meshes.filter(({ visible }) => visible);
    const [first] = ray.intersectObjects<Mesh>(seen, false);
    const index = first === undefined ? -1 : this.meshes.indexOf(first.object);
    const solid = this.solids[index];
    return first === undefined || solid === undefined ? null : { solid, index, point: first.point.toArray() };
  }

  // The point of a height under a pixel; null: the pixel shows the sky.
  level(x: number, y: number, height: number): PlanPoint | null {
    const at = this.ray(x, y).ray.intersectPlane(new Plane(new Vector3(0, 0, 1), -height), new Vector3());
    return at === null ? null : { x: at.x, y: at.y };
  }

  // The point under a pixel that is as far away as another one.
  beside(x: number, y: number, [px, py, pz]: Point3): Point3 {
    const through = new Vector3(px, py, pz);
    const normal = this.camera.getWorldDirection(new Vector3());
    const plane = new Plane().setFromNormalAndCoplanarPoint(normal, through);
    return (this.ray(x, y).ray.intersectPlane(plane, new Vector3()) ?? through).toArray();
  }

  // A point of a solid in its own frame, and where such a point is now.
  own(index: number, point: Point3): Point3 {
    const inverse = (this.meshes[index]?.matrix ?? new Matrix4()).clone().invert();
    return new Vector3(...point).applyMatrix4(inverse).toArray();
  }

  now(index: number, own: Point3): Point3 {
    return new Vector3(...own).applyMatrix4(this.meshes[index]?.matrix ?? new Matrix4()).toArray();
  }

  // The pixel of the canvas that shows a point.
  pixel(point: Point3): [number, number] {
    this.camera.updateMatrixWorld();
    const { x, y } = new Vector3(...point).project(this.camera);
    return [((x + 1) / 2) * this.size.x, ((1 - y) / 2) * this.size.y];
  }

  // Pixels of a unit of length at the middle of the view.
  scale(): number {
    const distance = this.camera.position.distanceTo(this.controls.target);
    return this.size.y / (2 * distance * Math.tan((ANGLE / 2) * (Math.PI / 180)));
  }

  render(width: number, height: number, ratio: number): void {
    this.draw(width, height, ratio);
  }

  override end(): void {
    this.clear();
    this.controls.dispose();
    this.arrow.dispose();
    super.end();
  }

  private clear(): void {
    for (const mesh of this.meshes) {
      mesh.removeFromParent();
      mesh.geometry.dispose();
      (mesh.material as MeshLambertMaterial).dispose();
    }
    this.meshes = [];
    this.solids = [];
  }
}
