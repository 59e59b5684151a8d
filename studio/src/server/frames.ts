// Arrays on the wire: a header of 16 bytes and raw float32, little-endian
// (src/deodar_studio/messages/frames.py).

export type Frame = {
  stream: number;
  frame: number;
  time: number;
  values: Float32Array;
};

const HEADER = 16;

export function decode(data: ArrayBuffer): Frame {
  const view = new DataView(data);
  return {
    stream: view.getUint32(0, true),
    frame: view.getUint32(4, true),
    time: view.getFloat64(8, true),
    values: new Float32Array(data, HEADER),
  };
}
