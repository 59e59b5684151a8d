// The world as the server showed it last: its objects, the positions of its bodies, and their paths.
// Many pictures a second pass through here, so that React renders only static parts.

import type { Bodies, BodyView, WorldScene, SceneView } from "../protocol";

export type Seen = {
  scene: SceneView | null;
  note: string;
  // Whether the world has a camera.
  camera?: boolean;
  bodies: BodyView[];
  path: number[][];
};

export class LiveWorld {
  private seen: Seen = { scene: null, note: "", bodies: [], path: [] };
  private listeners = new Set<() => void>();

  get now(): Seen {
    return this.seen;
  }

  // The static parts, as React reads them: the same object until it changes.
  readonly scene = (): SceneView | null => this.seen.scene;

  readonly note = (): string => this.seen.note;

  readonly camera = (): boolean => this.seen.camera ?? false;

  readonly listen = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  take(message: WorldScene | Bodies): void {
    if (message.type === "scene") {
      this.seen = {
        ...this.seen,
        scene: message.scene,
        note: message.note ?? "",
        camera: message.camera ?? false,
      };
    } else {
      const { bodies, fresh, path } = message;
      this.seen = { ...this.seen, bodies, path: fresh ? path : [...this.seen.path, ...path] };
    }
    this.listeners.forEach((listener) => listener());
  }
}

export const live = new LiveWorld();
