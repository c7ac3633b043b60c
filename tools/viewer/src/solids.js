import * as THREE from "three";
import { RoundedBoxGeometry } from "three/addons/geometries/RoundedBoxGeometry.js";
import { unpackTriangles, unpackVertices } from "./page_data.js";
import { backdrop } from "./studio.js";

const unitZ = new THREE.Vector3(0, 0, 1);
const vector = (xyz) => new THREE.Vector3(...xyz);

/** A mesh that knows where it is at a time. */
function moving(solid, object) {
  object.receiveShadow = true;
  object.castShadow = solid.shape !== "plane";
  const rest = object.position.clone();
  return { object, move: (time) => object.position.copy(rest).add(offset(solid, time)) };
}

/** The solids that end somewhere. */
export async function makeBodies(scene, blocks) {
  const bodies = scene.solids.filter(({ shape }) => shape !== "plane");
  return Promise.all(bodies.map(async (solid) => moving(solid, await makeBody(solid, blocks))));
}

/** The planes, where they are seen around a sphere (cm). */
export function makePlanes(scene, center, radius) {
  const planes = scene.solids.filter(({ shape }) => shape === "plane");
  return planes.map((solid) => moving(solid, makePlane(solid, center, radius)));
}

/** Taps: a short pipe behind each source, as wide as the stream. */
export function makeSources(scene) {
  return (scene.sources ?? []).map((source) => {
    const material = new THREE.MeshStandardMaterial({ color: 0x9aa7ad, metalness: 0.9, roughness: 0.3, side: THREE.DoubleSide });
    const length = 4 * source.radius, wall = 1.12 * source.radius;
    const pipe = new THREE.Mesh(new THREE.CylinderGeometry(wall, wall, length, 64, 1, true), material);
    const normal = vector(source.normal).normalize();
    pipe.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), normal);
    pipe.position.copy(vector(source.center)).addScaledVector(normal, -length / 2);
    pipe.castShadow = true;
    return { object: pipe, move: () => {} };
  });
}

/** How far a solid is from where its shape says (cm): as Solid::offset. */
export function offset(solid, time) {
  const keys = solid.keys ?? [];
  if (keys.length === 0) return vector(solid.velocity ?? [0, 0, 0]).multiplyScalar(time);
  const after = keys.findIndex((key) => key.time > time);
  if (after === 0) return vector(keys[0].position);
  if (after < 0) return vector(keys.at(-1).position);
  const [from, to] = [keys[after - 1], keys[after]];
  return vector(from.position).lerp(vector(to.position), (time - from.time) / (to.time - from.time));
}

/** The part of a plane below the drops, faded into the backdrop; ruled, so that one sees the water bend what is behind. */
function makePlane(solid, center, radius) {
  const normal = vector(solid.normal).normalize();
  const point = vector(solid.point);
  const middle = center.clone().addScaledVector(normal, normal.dot(point.clone().sub(center)));
  const spacing = 10 ** Math.round(Math.log10(radius / 3));
  const material = new THREE.MeshStandardMaterial({ color: 0xe8e4da, roughness: 0.95, envMapIntensity: 0.42 });
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, { spacing: { value: spacing }, reach: { value: radius }, backdrop: { value: backdrop } });
    shader.vertexShader = shader.vertexShader.replace("#include <common>", "#include <common>\nvarying vec2 onPlane;")
      .replace("#include <begin_vertex>", "#include <begin_vertex>\nonPlane = position.xy;");
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nvarying vec2 onPlane; uniform float spacing, reach; uniform vec3 backdrop;")
      .replace("#include <color_fragment>", `#include <color_fragment>
        vec2 cell = onPlane / spacing, width = fwidth(cell);
        vec2 lines = 1. - smoothstep(vec2(0.), 1.5 * width, abs(fract(cell - .5) - .5));
        diffuseColor.rgb *= 1. - .2 * max(lines.x, lines.y) * (1. - smoothstep(.2, .6, max(width.x, width.y)));`)
      .replace("#include <opaque_fragment>", `#include <opaque_fragment>
        gl_FragColor.rgb = mix(gl_FragColor.rgb, backdrop, smoothstep(1.3 * reach, 4.2 * reach, length(onPlane)));`);
  };
  const mesh = new THREE.Mesh(new THREE.CircleGeometry(4.5 * radius, 96), material);
  mesh.quaternion.setFromUnitVectors(unitZ, normal);
  mesh.position.copy(middle);
  return mesh;
}

async function makeBody(solid, blocks) {
  const material = new THREE.MeshStandardMaterial({ color: 0xd9c9b4, roughness: 0.75, envMapIntensity: 0.5 });
  const mesh = new THREE.Mesh(await geometryOf(solid, blocks), material);
  if (solid.shape === "sphere" || solid.shape === "box") mesh.position.set(...solid.center);
  if (solid.shape === "box") mesh.rotation.set(...solid.rotate_deg.map(THREE.MathUtils.degToRad), "ZYX");  // x first, about fixed axes
  if (solid.shape === "cylinder" || solid.shape === "capsule") {
    const from = vector(solid.from), to = vector(solid.to);
    mesh.position.copy(from).add(to).multiplyScalar(0.5);
    mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), to.sub(from).normalize());
  }
  return mesh;
}

/** A cylinder along y whose edges are rounded. */
function makeCylinder(radius, length, edge) {
  if (edge === 0) return new THREE.CylinderGeometry(radius, radius, length, 96);
  const profile = [new THREE.Vector2(0, -length / 2)];
  for (const side of [-1, 1])
    for (let k = 0; k <= 8; ++k) {
      const angle = (side < 0 ? -90 + k * 90 / 8 : k * 90 / 8) * Math.PI / 180;
      profile.push(new THREE.Vector2(radius - edge + edge * Math.cos(angle), side * (length / 2 - edge) + edge * Math.sin(angle)));
    }
  profile.push(new THREE.Vector2(0, length / 2));
  return new THREE.LatheGeometry(profile, 96);
}

async function geometryOf(solid, blocks) {
  const length = () => vector(solid.to).distanceTo(vector(solid.from));
  switch (solid.shape) {
    case "sphere": return new THREE.SphereGeometry(solid.radius, 96, 64);
    case "box": return solid.edge_radius > 0 ? new RoundedBoxGeometry(...solid.size, 6, solid.edge_radius) : new THREE.BoxGeometry(...solid.size);
    case "cylinder": return makeCylinder(solid.radius, length(), solid.edge_radius ?? 0);
    case "capsule": return new THREE.CapsuleGeometry(solid.radius, length(), 32, 96);
  }
  const { surface } = solid;
  const vertices = unpackVertices(await blocks.inflate(surface.block), surface);
  const corners = unpackTriangles(await blocks.inflate(surface.topology), surface.triangles, surface.vertices);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(vertices.positions, 3));
  geometry.setIndex(new THREE.BufferAttribute(corners, 1));
  geometry.computeVertexNormals();
  return geometry;
}
