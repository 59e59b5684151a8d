// The world as the server showed it last: its objects, the positions of its bodies, their paths, and its
// solids. Many pictures a second pass through here, so that React renders only static parts.

import type {
  Bodies,
  BodyView,
  PictureView,
  RobotLink,
  SceneView,
  SolidView,
  WorldScene,
  WorldSolids,
} from "../protocol";
import { bytesOf, floatsOf } from "../model/base64";

export type Seen = {
  scene: SceneView | null;
  // The session of the document for which the scene came.
  session: number;
  note: string;
  // Whether the world has a camera, whether it can be shown in three dimensions, and whether objects can be
  // added to it.
  camera: boolean;
  solid: boolean;
  canPlace: boolean;
  bodies: BodyView[];
  path: number[][];
  // What is drawn in three dimensions, and for each the position and the rows of the rotation matrix.
  solids: SolidView[];
  poses: Float32Array;
  // The picture that a camera of the world sees, and its red, green and blue, row by row from the top.
  picture: PictureView | null;
  pixels: Uint8Array;
  // The link with a robot in another process; null: the world is in that of the server.
  link: RobotLink | null;
};

export const NOTHING_SEEN: Seen = {
  scene: null,
  session: 0,
  note: "",
  camera: false,
  solid: false,
  canPlace: false,
  bodies: [],
  path: [],
  solids: [],
  poses: new Float32Array(),
  picture: null,
  pixels: new Uint8Array(),
  link: null,
};

export class LiveWorld {
  private seen = NOTHING_SEEN;
  private listeners = new Set<() => void>();

  get now(): Seen {
    return this.seen;
  }

  // The static parts, as React reads them: the same object until it changes.
  readonly scene = (): SceneView | null => this.seen.scene;

  readonly note = (): string => this.seen.note;

  readonly camera = (): boolean => this.seen.camera;

  readonly solid = (): boolean => this.seen.solid;

  readonly canPlace = (): boolean => this.seen.canPlace;

  readonly picture = (): PictureView | null => this.seen.picture;

  readonly link = (): RobotLink | null => this.seen.link;

  // Whether there is a robot, or a scene that came for a session of the document.
  readonly showsWorldOf = (session: number): boolean =>
    this.seen.link !== null || (this.seen.scene !== null && this.seen.session === session);

  readonly listen = (listener: () => void): (() => void) => {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  };

  take(message: WorldScene | WorldSolids | Bodies | RobotLink, session = 0): void {
    if (message.type === "scene") {
      this.seen = {
        ...this.seen,
        session,
        scene: message.scene,
        note: message.note ?? "",
        camera: message.camera ?? false,
        solid: message.solid ?? false,
        canPlace: message.can_place ?? false,
        picture: same(this.seen.picture, message.picture ?? null),
      };
    } else if (message.type === "robot_link") {
      this.seen = { ...this.seen, link: (message.robot ?? "") === "" ? null : message };
    } else if (message.type === "solids") {
      this.seen = { ...this.seen, solids: message.solids };
    } else {
      const { bodies, fresh, path, poses, picture } = message;
      this.seen = {
        ...this.seen,
        bodies,
        path: fresh ? path : [...this.seen.path, ...path],
        poses: floatsOf(poses ?? ""),
        pixels: bytesOf(picture ?? ""),
      };
    }
    this.listeners.forEach((listener) => listener());
  }
}

// The picture before where nothing changed, because React compares objects.
function same(before: PictureView | null, now: PictureView | null): PictureView | null {
  const equal = before?.name === now?.name && before?.columns === now?.columns && before?.rows === now?.rows;
  return equal ? before : now;
}

export const live = new LiveWorld();
