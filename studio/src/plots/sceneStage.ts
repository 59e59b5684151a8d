// Scenes in three dimensions, drawn by three.js. The page imports this file when the first of them is shown.

import {
  AmbientLight,
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  ColorManagement,
  DirectionalLight,
  DoubleSide,
  LinearFilter,
  LinearSRGBColorSpace,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  NearestFilter,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  WebGLRenderer,
} from "three";
import type { MapColors } from "./mapColors";
import { ANGLE, cameraAt, DISTANCE, magnification, type Point3, type Viewpoint } from "./sceneView";

// A plane through the box at right angles to an axis, from its lower end (0) to its upper end (1). The canvas
// has the first other axis to the right and the second one upwards.
export type Slice = { axis: 0 | 1 | 2; place: number; canvas: HTMLCanvasElement };

// The colours are those of the scales, not of a lamp on a surface of some material.
ColorManagement.enabled = false;

// Light from all sides, and from the camera: together 1 for a surface that faces the camera.
const [AMBIENT, DIRECTED] = [0.62 * Math.PI, 0.38 * Math.PI];

export class SceneStage {
  private renderer: WebGLRenderer;
  private scene = new Scene();
  private camera = new PerspectiveCamera(ANGLE, 1, DISTANCE - 2, DISTANCE + 2);
  private lamp = new DirectionalLight(0xffffff, DIRECTED);
  private surface: SurfaceMesh | null = null;
  private planes = new Map<number, Mesh<PlaneGeometry, MeshBasicMaterial>>();

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.camera.up.set(0, 0, 1);
    this.scene.add(new AmbientLight(0xffffff, AMBIENT), this.lamp);
  }

  // Show values over two axes as heights and colours. C order: index = ix * ny + iy.
  showSurface(values: Float32Array, nx: number, ny: number, size: Point3, colors: MapColors): void {
    if (this.surface === null || this.surface.nx !== nx || this.surface.ny !== ny) {
      this.surface?.end();
      this.surface = new SurfaceMesh(nx, ny);
      this.scene.add(this.surface.mesh);
    }
    this.surface.set(values, size, colors);
  }

  // Show planes, at most one for each axis.
  showSlices(slices: Slice[], size: Point3): void {
    for (const { axis, place, canvas } of slices) {
      const [across, up] = [0, 1, 2].filter((d) => d !== axis) as [number, number];
      let plane = this.planes.get(axis);
      if (plane?.material.map?.image !== canvas) {
        plane?.removeFromParent();
        plane = new Mesh(
          new PlaneGeometry(),
          new MeshBasicMaterial({ side: DoubleSide, map: texture(canvas) }),
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

  // Draw; lengths in pixels of the page, `ratio` pixels of the canvas for each.
  render(view: Viewpoint, width: number, height: number, ratio: number): void {
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.zoom = magnification(view, width, height);
    const [x, y, z] = cameraAt(view);
    this.camera.position.set(x, y, z);
    // Straight above, another direction has to be up.
    const upright = Math.abs(view.elevation) < 89.9;
    const radians = (view.azimuth * Math.PI) / 180;
    this.camera.up.set(...((upright ? [0, 0, 1] : [-Math.cos(radians), -Math.sin(radians), 0]) as Triple));
    this.camera.lookAt(0, 0, 0);
    this.camera.updateProjectionMatrix();
    this.lamp.position.set(x, y, z + DISTANCE);
    this.renderer.render(this.scene, this.camera);
  }

  end(): void {
    this.surface?.end();
    for (const { geometry, material } of this.planes.values()) {
      geometry.dispose();
      material.map?.dispose();
      material.dispose();
    }
    this.renderer.dispose();
    // A browser has few contexts.
    this.renderer.forceContextLoss();
  }
}

type Triple = [number, number, number];

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
    this.mesh = new Mesh(geometry, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }));
    // Every vertex moves: it is never out of view.
    this.mesh.frustumCulled = false;
  }

  set(values: Float32Array, size: Point3, { range: [low, high], table }: MapColors): void {
    const { nx, ny } = this;
    const [place, normal, color] = [this.positions, this.normals, this.colors].map(
      ({ array }) => array as Float32Array,
    ) as [Float32Array, Float32Array, Float32Array];
    const [stepX, stepY] = [size[0] / Math.max(1, nx - 1), size[1] / Math.max(1, ny - 1)];
    const share = (i: number) => Math.min(1, Math.max(0, ((values[i] as number) - low) / (high - low))) || 0;
    for (let i = 0, at = 0; i < nx; i++) {
      for (let j = 0; j < ny; j++, at++) {
        const part = share(at);
        place[3 * at] = i * stepX - size[0] / 2;
        place[3 * at + 1] = j * stepY - size[1] / 2;
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
