// GLB and USDA as other programs' readers see them: the Khronos validator and three.js. The PLY frames are the truth.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { after, before, test } from "node:test";
import { inflateSync } from "node:zlib";

const modules = process.env.NODE_MODULES;
const validator = createRequire(join(modules, "x.js"))("gltf-validator");
const { USDAParser } = await import(pathToFileURL(join(modules, "three/examples/jsm/loaders/usd/USDAParser.js")));
const { unpackTriangles, unpackVertices } = await import(pathToFileURL(join(process.env.VIEWER, "src/page_data.js")));
const meniscus = (...args) => execFileSync(process.env.MENISCUS, args);
const numFrames = 13;

const directory = mkdtempSync(join(tmpdir(), "meniscus_formats_"));
const inside = (name) => join(directory, name);
const frameName = (k, extension) => inside(`run/frame_${String(k).padStart(4, "0")}.${extension}`);

before(() => {  // a ball that touches the plate in the second frame
  writeFileSync(inside("scene.json"), JSON.stringify({
    time_step: 1 / 960, frames: numFrames - 1, mesh: { edge_min: 0.015, edge_max: 0.045 },
    solids: [{ shape: "plane", advancing_angle_deg: 70, receding_angle_deg: 50 }],
    drops: [{ shape: "sphere", center: [0, 0, 0.25], radius: 0.2, velocity: [0, 0, -30] }],
  }));
  meniscus("evolve", inside("scene.json"), "-o", inside("run"), "--frames-as", "glb,usda,obj", "-q");
});
after(() => rmSync(directory, { recursive: true }));

/** Our binary PLY: float64 x y z vx vy vz, int32 drop, uchar contact, then triangles. */
function readPly(file) {
  const bytes = readFileSync(file);
  const end = bytes.indexOf("end_header\n") + 11;
  const header = bytes.subarray(0, end).toString();
  const n = Number(/element vertex (\d+)/.exec(header)[1]), m = Number(/element face (\d+)/.exec(header)[1]);
  const properties = [...header.matchAll(/property (double|int|uchar) (\w+)/g)].map((match) => match[2]);
  assert.deepEqual(properties, ["x", "y", "z", "vx", "vy", "vz", "drop", "contact"]);
  const at = (v, k) => bytes.readDoubleLE(end + 53 * v + 8 * k);
  const vectors = (first) => Array.from({ length: n }, (_, v) => [0, 1, 2].map((k) => at(v, first + k)));
  const contact = Array.from({ length: n }, (_, v) => bytes[end + 53 * v + 52]);
  const triangles = Array.from({ length: 3 * m }, (_, k) => bytes.readInt32LE(end + 53 * n + 13 * Math.floor(k / 3) + 1 + 4 * (k % 3)));
  return { points: vectors(0), velocities: vectors(3), contact, triangles, time: Number(/comment time (\S+)/.exec(header)[1]) };
}

const toFloats = (vectors) => [...Float32Array.from(vectors.flat())];

/** An accessor's numbers. */
function read(gltf, binary, index) {
  const accessor = gltf.accessors[index], view = gltf.bufferViews[accessor.bufferView];
  const width = { SCALAR: 1, VEC3: 3 }[accessor.type];
  const Numbers = { 5125: Uint32Array, 5126: Float32Array }[accessor.componentType];
  const start = binary.byteOffset + (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
  return [...new Numbers(binary.buffer.slice(start, start + 4 * width * accessor.count))];
}

async function readGlb(file) {
  const bytes = readFileSync(file);
  const report = await validator.validateBytes(new Uint8Array(bytes));
  assert.equal(report.issues.numErrors + report.issues.numWarnings, 0, JSON.stringify(report.issues.messages, null, 1));
  const length = bytes.readUInt32LE(12);
  return { gltf: JSON.parse(bytes.subarray(20, 20 + length).toString()), binary: bytes.subarray(28 + length) };
}

test("GLB stills pass the Khronos validator and hold the PLY's numbers", async () => {
  for (const k of [0, numFrames - 1]) {
    const ply = readPly(frameName(k, "ply"));
    const { gltf, binary } = await readGlb(frameName(k, "glb"));
    const [{ attributes, indices }] = gltf.meshes[0].primitives;
    assert.deepEqual(read(gltf, binary, attributes.POSITION), toFloats(ply.points));
    assert.deepEqual(read(gltf, binary, attributes._VELOCITY), toFloats(ply.velocities));
    assert.deepEqual(read(gltf, binary, attributes._CONTACT), ply.contact);
    assert.deepEqual(read(gltf, binary, indices), ply.triangles);
    const normals = read(gltf, binary, attributes.NORMAL);
    if (k === 0)  // a ball about (0, 0, 0.25): normals point away from its middle
      ply.points.forEach(([x, y, z], v) => {
        const [nx, ny, nz] = normals.slice(3 * v, 3 * v + 3);
        assert.ok((x * nx + y * ny + (z - 0.25) * nz) / Math.hypot(x, y, z - 0.25) > 0.99);
      });
    else assert.ok(ply.contact.includes(2), "the last frame has a contact line");
  }
});

test("a flipbook shows each frame in its time only", async () => {
  meniscus("convert", inside("run"), inside("run.glb"));
  const { gltf, binary } = await readGlb(inside("run.glb"));
  assert.equal(gltf.meshes.length, numFrames);
  const shown = (time) => gltf.animations[0].channels.filter(({ sampler }) => {
    const { input, output, interpolation } = gltf.animations[0].samplers[sampler];
    assert.equal(interpolation, "STEP");
    const times = read(gltf, binary, input), scales = read(gltf, binary, output);
    const key = Math.max(0, times.findLastIndex((t) => t <= time));
    return scales[3 * key] > 0;
  }).map(({ target }) => gltf.nodes[target.node].mesh);
  for (let k = 0; k < numFrames; ++k) {
    const ply = readPly(frameName(k, "ply"));
    assert.deepEqual(shown(ply.time + 1e-4), [k]);
    assert.deepEqual(read(gltf, binary, gltf.meshes[k].primitives[0].attributes.POSITION), toFloats(ply.points));
    assert.deepEqual(read(gltf, binary, gltf.meshes[k].primitives[0].indices), ply.triangles);
  }
});

test("USDA holds points, faces and velocities of every frame, sampled in time", () => {
  const text = readFileSync(inside("run/frames.usda"), "utf8");
  assert.match(text, /timeCodesPerSecond = 240\n/);
  const { specsByPath } = new USDAParser().parseData(text);
  const samples = (name) => specsByPath[`/drops/liquid.${name}`].fields.timeSamples;
  for (const name of ["points", "velocities", "faceVertexIndices", "faceVertexCounts", "extent", "primvars:contact"])
    assert.deepEqual(samples(name).times, [...Array(numFrames).keys()], name);
  for (let k = 0; k < numFrames; ++k) {
    const ply = readPly(frameName(k, "ply"));
    assert.deepEqual([...Float32Array.from(samples("points").values[k])], toFloats(ply.points));
    assert.deepEqual([...Float32Array.from(samples("velocities").values[k])], toFloats(ply.velocities));
    assert.deepEqual([...samples("faceVertexIndices").values[k]], ply.triangles);
    assert.deepEqual([...samples("primvars:contact").values[k]], ply.contact);
    assert.equal(samples("faceVertexCounts").values[k].length, ply.triangles.length / 3);
  }
});

test("the page's own unpacking is within half a step of the frames", () => {
  meniscus("view", inside("run"), "--html", inside("run.html"), "-q");
  const html = readFileSync(inside("run.html"), "utf8");
  const data = JSON.parse(/<script type="application\/json" id="scene">(.*?)<\/script>/.exec(html)[1]);
  const blocks = /<script type="text\/plain" id="blocks">\n(.*?)<\/script>/s.exec(html)[1].split("\n");
  const inflate = (k) => new Uint8Array(inflateSync(Buffer.from(blocks[k], "base64")));
  assert.equal(data.frames.length, numFrames);
  data.frames.forEach((frame, k) => {
    const ply = readPly(frameName(k, "ply"));
    const { positions, speed, contact } = unpackVertices(inflate(frame.block), frame);
    assert.deepEqual([...unpackTriangles(inflate(frame.topology), frame.triangles, frame.vertices)], ply.triangles);
    assert.deepEqual([...contact], ply.contact);
    assert.equal(frame.time, ply.time);
    ply.points.forEach((p, v) => p.forEach((x, axis) => assert.ok(Math.abs(positions[3 * v + axis] - x) < 0.5001 * frame.step[axis] + 1e-6)));
    ply.velocities.forEach((u, v) => assert.ok(Math.abs(speed[v] * frame.speed / 255 - Math.hypot(...u)) < frame.speed / 500));
  });
});
