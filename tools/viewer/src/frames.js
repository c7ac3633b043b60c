import { unpackTriangles, unpackVertices } from "./page_data.js";

const keptFrames = 48;  // unpacked ones, for playing and for going back

/** Unpacks frames when they are asked for, and keeps the last ones. */
export class Frames {
  constructor(scene, blocks) {
    this.list = scene.frames;
    this.blocks = blocks;
    this.kept = new Map();
    this.topologies = new Map();
  }

  /** A promise of { positions, corners, speed, contact, drop }. */
  get(number) {
    const known = this.kept.get(number);
    if (known) this.kept.delete(number);  // the newest comes last
    const surface = known ?? this.unpack(this.list[number]);
    this.kept.set(number, surface);
    for (const oldest of this.kept.keys()) {
      if (this.kept.size <= keptFrames) break;
      this.kept.delete(oldest);
    }
    return surface;
  }

  async unpack(frame) {
    const [bytes, corners] = await Promise.all([this.blocks.inflate(frame.block), this.corners(frame)]);
    return { ...unpackVertices(bytes, frame), corners };
  }

  corners(frame) {
    if (!this.topologies.has(frame.topology)) {
      if (this.topologies.size > keptFrames) this.topologies.clear();
      this.topologies.set(frame.topology, this.blocks.inflate(frame.topology)
        .then((bytes) => unpackTriangles(bytes, frame.triangles, frame.vertices)));
    }
    return this.topologies.get(frame.topology);
  }
}
