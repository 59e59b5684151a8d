// Scenes in three dimensions, drawn by three.js. The page imports this file when the first of them is shown.

import {
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  DoubleSide,
  LinearFilter,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  NearestFilter,
  PerspectiveCamera,
  PlaneGeometry,
  Sphere,
  Vector3,
} from "three";
import type { MapColors } from "../../draw/content";
import { ANGLE, cameraAt, DISTANCE, magnification, type Point3, type Viewpoint } from "../../model/sceneView";
import { shade } from "../../model/colors";
import { WebGLStage } from "./webGLStage";

// A plane through the box at right angles to an axis, from its lower end (0) to its upper end (1). The canvas
// has the first other axis to the right and the second one upwards.
export type Slice = { axis: 0 | 1 | 2; place: number; canvas: HTMLCanvasElement };

// What a ray from the camera meets first: a point of the box, and the axis of the slice that it is on.
export type Hit = { point: Point3; slice: 0 | 1 | 2 | null };

// The share of the light from all sides.
const AMBIENT = 0.62;

export class SceneStage extends WebGLStage {
  private surface: SurfaceMesh | null = null;
  private planes = new Map<number, Mesh<PlaneGeometry, MeshBasicMaterial>>();
  private places = new Map<number, number>();
  private box: Point3 = [1, 1, 1];
  private cursor = new LineSegments(new BufferGeometry(), new LineBasicMaterial());

  constructor(canvas: HTMLCanvasElement) {
    super(canvas, new PerspectiveCamera(ANGLE, 1, DISTANCE - 2, DISTANCE + 2), AMBIENT, DISTANCE);
    this.cursor.frustumCulled = false;
    this.scene.add(this.cursor);
  }

  // Show values over two axes as heights and colours. C order: index = ix * ny + iy.
  showSurface(values: Float32Array, nx: number, ny: number, size: Point3, colors: MapColors): void {
    if (this.surface === null || this.surface.nx !== nx || this.surface.ny !== ny) {
      this.surface?.end();
      this.surface = new SurfaceMesh(nx, ny);
      this.scene.add(this.surface.mesh);
    }
    this.box = size;
    this.surface.set(values, size, colors);
  }

  // Show planes, at most one for each axis.
  showSlices(slices: Slice[], size: Point3): void {
    this.box = size;
    for (const { axis, place, canvas } of slices) {
      this.places.set(axis, place);
      const [across, up] = [0, 1, 2].filter((d) => d !== axis) as [number, number];
      let plane = this.planes.get(axis);
      if (plane?.material.map?.image !== canvas) {
        plane?.removeFromParent();
        plane = new Mesh(
          new PlaneGeometry(),
          new MeshBasicMaterial({ side: DoubleSide, map: texture(canvas), ...BEHIND_LINES }),
        );
        this.scene.add(plane);
        this.planes.set(axis, plane);
      }
      const corners = plane.geometry.getAttribute("position");
      [
        [-1, 1],
        [1, 1],
        [-1, -1],
        [1, -1],
      ].forEach(([a = 0, b = 0], i) => {
        const point = [0, 0, 0];
        point[axis] = (place - 0.5) * size[axis];
        point[across] = (a / 2) * (size[across] as number);
        point[up] = (b / 2) * (size[up] as number);
        corners.setXYZ(i, ...(point as [number, number, number]));
      });
      corners.needsUpdate = true;
      plane.geometry.computeBoundingSphere();
      (plane.material.map as CanvasTexture).needsUpdate = true;
    }
  }

  // Show lines on the surface and on the slices where the cursor is: a share of the box along each axis, null
  // where it has no position.
  showCursor(shares: readonly (number | null)[], color: string): void {
    const points = [
      ...(this.surface?.lines(shares, this.box) ?? []),
      ...[...this.places].flatMap(([axis, place]) => this.linesOnSlice(axis, place, shares)),
    ];
    this.cursor.geometry.dispose();
    this.cursor.geometry = new BufferGeometry().setFromPoints(points.map((point) => new Vector3(...point)));
    this.cursor.material.color.set(color);
    this.cursor.visible = points.length > 0;
  }

  // What lies under a pixel of the page, from the top left, in the view that was drawn last.
  hit(x: number, y: number): Hit | null {
    const meshes = [...(this.surface === null ? [] : [this.surface.mesh]), ...this.planes.values()];
    const [first] = this.ray(x, y).intersectObjects(meshes, false);
    if (first === undefined) {
      return null;
    }
    const slice = [...this.planes].find(([, plane]) => plane === first.object)?.[0] ?? null;
    return { point: first.point.toArray(), slice: slice as Hit["slice"] };
  }

  private linesOnSlice(axis: number, place: number, shares: readonly (number | null)[]): Point3[] {
    return [0, 1, 2].flatMap((d) => {
      const share = shares[d] ?? null;
      const rest = [0, 1, 2].find((other) => other !== axis && other !== d) as number;
      if (d === axis || share === null) {
        return [];
      }
      return [0, 1].map((end) => {
        const at = [0, 0, 0];
        [at[axis], at[d], at[rest]] = [place, share, end];
        return at.map((part, k) => (part - 0.5) * (this.box[k] as number)) as Triple;
      });
    });
  }

  render(view: Viewpoint, width: number, height: number, ratio: number): void {
    this.camera.zoom = magnification(view, width, height);
    this.camera.position.set(...(cameraAt(view) as Triple));
    // Straight above, another direction has to be up.
    const upright = Math.abs(view.elevation) < 89.9;
    const radians = (view.azimuth * Math.PI) / 180;
    this.camera.up.set(...((upright ? [0, 0, 1] : [-Math.cos(radians), -Math.sin(radians), 0]) as Triple));
    this.camera.lookAt(0, 0, 0);
    this.draw(width, height, ratio);
  }

  override end(): void {
    this.surface?.end();
    this.cursor.geometry.dispose();
    this.cursor.material.dispose();
    for (const { geometry, material } of this.planes.values()) {
      geometry.dispose();
      material.map?.dispose();
      material.dispose();
    }
    super.end();
  }
}

type Triple = [number, number, number];

// Lines on a plane are drawn above it.
const BEHIND_LINES = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 2 };

class SurfaceMesh {
  readonly mesh: Mesh<BufferGeometry, MeshLambertMaterial>;
  private positions: BufferAttribute;
  private normals: BufferAttribute;
  private colors: BufferAttribute;

  constructor(
    readonly nx: number,
    readonly ny: number,
  ) {
    const attribute = () => new BufferAttribute(new Float32Array(3 * nx * ny), 3);
    [this.positions, this.normals, this.colors] = [attribute(), attribute(), attribute()];
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", this.positions);
    geometry.setAttribute("normal", this.normals);
    geometry.setAttribute("color", this.colors);
    const corners: number[] = [];
    for (let i = 0; i + 1 < nx; i++) {
      for (let j = 0; j + 1 < ny; j++) {
        const at = i * ny + j;
        corners.push(at, at + ny, at + 1, at + 1, at + ny, at + ny + 1);
      }
    }
    geometry.setIndex(corners);
    // The vertices move inside the box.
    geometry.boundingSphere = new Sphere(new Vector3(), 1);
    const material = new MeshLambertMaterial({ vertexColors: true, side: DoubleSide, ...BEHIND_LINES });
    this.mesh = new Mesh(geometry, material);
    // Every vertex moves: it is never out of view.
    this.mesh.frustumCulled = false;
  }

  set(values: Float32Array, size: Point3, { range: [low, high], tables }: MapColors): void {
    const table = tables[shade()];
    const { nx, ny } = this;
    const [place, normal, color] = [this.positions, this.normals, this.colors].map(
      ({ array }) => array as Float32Array,
    ) as [Float32Array, Float32Array, Float32Array];
    // Each sample is in the middle of its part of the axis.
    const [stepX, stepY] = [size[0] / nx, size[1] / ny];
    const share = (i: number) => Math.min(1, Math.max(0, ((values[i] as number) - low) / (high - low))) || 0;
    for (let i = 0, at = 0; i < nx; i++) {
      for (let j = 0; j < ny; j++, at++) {
        const part = share(at);
        place[3 * at] = (i + 0.5) * stepX - size[0] / 2;
        place[3 * at + 1] = (j + 0.5) * stepY - size[1] / 2;
        place[3 * at + 2] = (part - 0.5) * size[2];
        const from = 4 * Math.round(255 * part);
        for (let c = 0; c < 3; c++) {
          color[3 * at + c] = (table[from + c] as number) / 255;
        }
      }
    }
    for (let i = 0, at = 0; i < nx; i++) {
      for (let j = 0; j < ny; j++, at++) {
        const [left, right] = [i > 0 ? at - ny : at, i + 1 < nx ? at + ny : at];
        const [before, after] = [j > 0 ? at - 1 : at, j + 1 < ny ? at + 1 : at];
        const height = (k: number) => place[3 * k + 2] as number;
        const slopeX = (height(right) - height(left)) / (stepX * Math.max(1, (right - left) / ny));
        const slopeY = (height(after) - height(before)) / (stepY * Math.max(1, after - before));
        const length = Math.hypot(slopeX, slopeY, 1);
        normal[3 * at] = -slopeX / length;
        normal[3 * at + 1] = -slopeY / length;
        normal[3 * at + 2] = 1 / length;
      }
    }
    for (const attribute of [this.positions, this.normals, this.colors]) {
      attribute.needsUpdate = true;
    }
  }

  // Segments along the surface at a share of the first and of the second axis.
  lines([across = null, up = null]: readonly (number | null)[], size: Point3): Point3[] {
    const { nx, ny } = this;
    const { array } = this.positions;
    const vertex = (i: number, j: number): Triple => {
      const at = 3 * (i * ny + j);
      return [array[at] as number, array[at + 1] as number, array[at + 2] as number];
    };
    const near = (share: number, count: number) => Math.min(count - 1, Math.floor(share * count));
    const segments = (count: number, point: (k: number) => Point3) =>
      Array.from({ length: Math.max(0, count - 1) }, (_, k) => [point(k), point(k + 1)]).flat();
    return [
      ...(across === null
        ? []
        : segments(ny, (j) => {
            const [, y, z] = vertex(near(across, nx), j);
            return [(across - 0.5) * size[0], y, z];
          })),
      ...(up === null
        ? []
        : segments(nx, (i) => {
            const [x, , z] = vertex(i, near(up, ny));
            return [x, (up - 0.5) * size[1], z];
          })),
    ];
  }

  end(): void {
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

function texture(canvas: HTMLCanvasElement): CanvasTexture {
  const made = new CanvasTexture(canvas);
  made.magFilter = NearestFilter;
  made.minFilter = LinearFilter;
  made.generateMipmaps = false;
  return made;
}
