// What the stages of three.js have in common: a camera, a light from all sides and one from the camera, the
// ray through a pixel, and the end.

import {
  AmbientLight,
  ColorManagement,
  DirectionalLight,
  LinearSRGBColorSpace,
  type PerspectiveCamera,
  Raycaster,
  Scene,
  Vector2,
  WebGLRenderer,
} from "three";

// The colours are those of the scales and of the models, not of a lamp on a surface of some material.
ColorManagement.enabled = false;

export class WebGLStage {
  protected scene = new Scene();
  // Pixels of the page.
  protected size = new Vector2(1, 1);
  private renderer: WebGLRenderer;
  private lamp: DirectionalLight;

  // `ambient`: the share of the light that comes from all sides; a surface that faces the camera gets 1. The
  // lamp is `above` the camera.
  constructor(
    readonly canvas: HTMLCanvasElement,
    protected camera: PerspectiveCamera,
    ambient: number,
    private above: number,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    this.lamp = new DirectionalLight(0xffffff, (1 - ambient) * Math.PI);
    camera.up.set(0, 0, 1);
    this.scene.add(new AmbientLight(0xffffff, ambient * Math.PI), this.lamp);
  }

  // Draw; lengths in pixels of the page, `ratio` pixels of the canvas for each.
  protected draw(width: number, height: number, ratio: number): void {
    this.size.set(width, height);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.lamp.position.copy(this.camera.position).z += this.above;
    this.renderer.render(this.scene, this.camera);
  }

  // Through a pixel of the page, from the top left.
  protected ray(x: number, y: number): Raycaster {
    this.camera.updateMatrixWorld();
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2((2 * x) / this.size.x - 1, 1 - (2 * y) / this.size.y), this.camera);
    return ray;
  }

  end(): void {
    this.renderer.dispose();
    // A browser has few contexts.
    this.renderer.forceContextLoss();
  }
}
