import * as THREE from "three";
import { Colors } from "./colors.js";
import { boxOfLiquid } from "./home.js";
import { addNormals, curvature, splitWetted } from "./measure.js";
import { sunDirection } from "./studio.js";

/** The drops of one frame as a mesh: group 0 is the free surface, group 1 what lies on solids. */
export class Liquid {
  constructor(scene) {
    const vertices = Math.max(3, ...scene.frames.map((f) => f.vertices));
    const triangles = Math.max(1, ...scene.frames.map((f) => f.triangles));
    this.colors = new Colors(scene.speed_max);
    this.geometry = new THREE.BufferGeometry();
    for (const name of ["position", "normal", "color"])
      this.geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(3 * vertices), 3).setUsage(THREE.DynamicDrawUsage));
    this.geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(3 * triangles), 1).setUsage(THREE.DynamicDrawUsage));
    this.geometry.boundingSphere = boxOfLiquid(scene).getBoundingSphere(new THREE.Sphere());
    this.water = waterMaterial(scene.drop_radius);
    this.plain = new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.45, envMapIntensity: 0.8 });
    this.wetted = new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.6, flatShading: true, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 });
    this.hidden = new THREE.MeshBasicMaterial({ visible: false });
    this.mesh = new THREE.Mesh(this.geometry, [this.water, this.hidden]);
    this.mesh.castShadow = true;
    this.edges = new THREE.Mesh(this.geometry, new THREE.MeshBasicMaterial({ wireframe: true, color: 0x12303f, transparent: true, opacity: 0.5 }));
    this.edges.visible = false;
    this.edges.renderOrder = 1;
    this.object = new THREE.Group().add(this.mesh, this.edges);
    this.materials = [this.water, this.plain, this.wetted];
  }

  /** Shows a surface as `look` says; returns the legend's HTML. */
  show(surface, frame, look) {
    const { position, normal, color } = this.geometry.attributes;
    position.array.set(surface.positions);
    const index = this.geometry.index.array, corners = surface.corners.length;
    const free = splitWetted(surface.corners, surface.contact, index);
    normal.array.fill(0, 0, 3 * frame.vertices);
    addNormals(surface.positions, index, 0, free, normal.array);  // the wetted side would bend them at the contact line
    unitLengths(normal.array, 3 * frame.vertices);
    const clear = look === "water";
    const legend = clear ? "" : this.colors.fill(look, surface, frame, () => (surface.curvature ??= curvature(surface.positions, surface.corners)), color.array);
    for (const attribute of [position, normal, color, this.geometry.index]) upload(attribute, attribute === this.geometry.index ? corners : 3 * frame.vertices);
    this.geometry.clearGroups();
    this.geometry.addGroup(0, free, 0);
    this.geometry.addGroup(free, corners - free, 1);
    this.geometry.setDrawRange(0, corners);
    this.mesh.material = clear ? [this.water, this.hidden] : [this.plain, this.wetted];
    this.object.visible = corners > 0;
    return legend;
  }
}

/** Clear, with water's index of refraction. Three.js bends light at the first surface only; what the whole drop does
 *  to the sun, a lens that leaves its lit side dark and its far side bright, is painted on by the normal. */
function waterMaterial(radius) {
  const material = new THREE.MeshPhysicalMaterial({
    roughness: 0, ior: 1.333, transmission: 1, thickness: 1.2 * radius, envMapIntensity: 1.3,
    attenuationColor: new THREE.Color(0.55, 0.82, 0.96), attenuationDistance: 4 * radius,
  });
  material.onBeforeCompile = (shader) => {
    shader.uniforms.sun = { value: sunDirection };
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nuniform vec3 sun;")
      .replace("#include <normal_fragment_maps>", `#include <normal_fragment_maps>
        vec3 outward = inverseTransformDirection(normal, viewMatrix);
        float facing = dot(outward, sun), behind = max(dot(outward, normalize(vec3(-sun.xy, -.35))), 0.);
        diffuseColor.rgb *= 1. - .38 * smoothstep(-.2, 1., facing) + .75 * behind * behind * behind;`);
  };
  return material;
}

function unitLengths(normals, end) {
  for (let k = 0; k < end; k += 3) {
    const length = Math.hypot(normals[k], normals[k + 1], normals[k + 2]);
    if (length === 0) continue;
    normals[k] /= length;
    normals[k + 1] /= length;
    normals[k + 2] /= length;
  }
}

function upload(attribute, count) {
  attribute.clearUpdateRanges();
  attribute.addUpdateRange(0, count);
  attribute.needsUpdate = true;
}
