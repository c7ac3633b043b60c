// What `meniscus view` put into the page: the scene as JSON, and blocks of deflated bytes as lines of base64.
// src/frames/packed_surface.cpp writes them.

/** An error to show to the person who opened the page. */
export class PageError extends Error {}

const damaged = (what) => new PageError(`This file is damaged: ${what}. Write it again with meniscus view.`);

const text = (id) => document.getElementById(id)?.textContent ?? "";

/** The frame list, bounds and solids. Throws PageError if they are missing or cut off. */
export function readScene() {
  const json = text("scene").trim();
  if (!json) throw new PageError("There are no drops in this file. Write it with meniscus view.");
  let scene;
  try {
    scene = JSON.parse(json);
  } catch {
    throw damaged("the list of frames cannot be read");
  }
  if (scene.format !== 1 || !Array.isArray(scene.frames)) throw damaged("the list of frames is not one");
  if (scene.frames.length === 0) throw new PageError("There are no frames in this file.");
  return scene;
}

/** The blocks, found by number and inflated one at a time. */
export class Blocks {
  constructor(count) {
    this.text = text("blocks");
    this.starts = [];
    for (let at = this.text.indexOf("\n"); at >= 0; at = this.text.indexOf("\n", at + 1)) this.starts.push(at + 1);
    if (this.starts.length < count + 1)  // each block lies between two line ends
      throw damaged(`it ends early, with ${Math.max(0, this.starts.length - 1)} of ${count} blocks`);
  }

  async inflate(number) {
    try {
      const binary = atob(this.text.slice(this.starts[number], this.starts[number + 1] - 1));
      const bytes = Uint8Array.from(binary, (c) => c.charCodeAt(0));
      const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
      return new Uint8Array(await new Response(stream).arrayBuffer());
    } catch {
      throw damaged(`block ${number} cannot be unpacked`);
    }
  }
}

/** The box of a packed surface: positions are 16-bit numbers of steps from `min`. */
export const boundsOf = ({ min, step }) => ({ min, max: min.map((low, axis) => low + 65535 * step[axis]) });

/** Reads numbers of 7 bits a byte, lowest first, with the sign in the lowest bit. */
class Varints {
  constructor(bytes, at = 0) {
    this.bytes = bytes;
    this.at = at;
  }
  next() {
    let value = 0;
    for (let shift = 0; ; shift += 7) {
      if (this.at >= this.bytes.length) throw damaged("a block is too short");
      const byte = this.bytes[this.at++];
      value |= (byte & 127) << shift;
      if (byte < 128) return (value >>> 1) ^ -(value & 1);
    }
  }
}

/** Positions (cm), speed (0 to 255 of frame.speed), contact and drop of each vertex. */
export function unpackVertices(bytes, frame) {
  const n = frame.vertices;
  if (bytes.length < 8 * n) throw damaged("a block is too short");
  const positions = new Float32Array(3 * n);
  for (let axis = 0; axis < 3; ++axis) {
    const high = 2 * n * axis, low = high + n;
    const origin = frame.min[axis], step = frame.step[axis];
    for (let v = 0, q = 0; v < n; ++v) {
      const zigzag = (bytes[high + v] << 8) | bytes[low + v];
      q = (q + ((zigzag >>> 1) ^ -(zigzag & 1))) & 0xffff;
      positions[3 * v + axis] = origin + step * q;
    }
  }
  const varints = new Varints(bytes, 8 * n);
  const drop = new Int32Array(n);
  for (let v = 0, d = 0; v < n; ++v) drop[v] = d += varints.next();
  return { positions, speed: bytes.subarray(6 * n, 7 * n), contact: bytes.subarray(7 * n, 8 * n), drop };
}

/** Corners of triangles; each is the one before it plus a difference. */
export function unpackTriangles(bytes, triangles, vertices) {
  const varints = new Varints(bytes);
  const corners = new Uint32Array(3 * triangles);
  for (let k = 0, v = 0; k < corners.length; ++k) {
    corners[k] = v += varints.next();
    if (v < 0 || v >= vertices) throw damaged("a triangle names a vertex that is not there");
  }
  return corners;
}
