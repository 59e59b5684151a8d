// Numbers that a message carries as base64.

export function bytesOf(text: string): Uint8Array<ArrayBuffer> {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}

export function floatsOf(text: string): Float32Array {
  return new Float32Array(bytesOf(text).buffer);
}

export function integersOf(text: string): Int32Array {
  return new Int32Array(bytesOf(text).buffer);
}
