import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { PageError } from "./page_data.js";
import { backdrop, direction, makeEnvironment, makeSun } from "./studio.js";

/** The renderer, the camera and the light, around a sphere (cm) that is to be seen whole. */
export class Stage {
  constructor(canvas, center, radius, normals) {
    this.canvas = canvas;
    this.center = center;
    this.radius = radius;
    this.normals = normals;
    try {
      this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    } catch {
      throw new PageError("This browser shows no WebGL 2, which this page needs. Try another browser, or turn hardware acceleration on.");
    }
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.VSMShadowMap;
    this.scene = new THREE.Scene();
    this.scene.background = backdrop;
    this.environment = makeEnvironment(this.renderer);
    const sun = makeSun(center, radius);
    this.scene.add(sun, sun.target);
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.02 * radius, 60 * radius);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("start", () => (this.isTurned = true));
    canvas.addEventListener("webglcontextrestored", () => this.draw());
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  /** Puts an object on the stage, and its materials in the stage's light. */
  add(object, materials) {
    for (const material of materials) material.envMap = this.environment;
    this.scene.add(object);
  }

  /** The view from the start, which may be given: an azimuth and elevation (degrees), `zoom` times as near, towards a
   *  target (cm). */
  home(view = this.view ?? {}) {
    this.view = view;
    this.isTurned = false;
    const { azimuth, elevation, zoom = 1, target } = view;
    const usual = this.usualDirection();
    const towards = direction(azimuth ?? usual.azimuth, elevation ?? usual.elevation);
    const half = THREE.MathUtils.degToRad(this.camera.fov / 2), aspect = Math.min(1, this.camera.aspect);
    this.controls.target.copy(target ? new THREE.Vector3(...target) : this.center);
    this.camera.position.copy(this.controls.target).addScaledVector(towards, 0.8 * this.radius / Math.sin(half) / aspect / zoom);
    this.controls.update();
    this.draw();
  }

  /** From in front and a little above, or facing the first upright plane. */
  usualDirection() {
    const upright = this.normals.find((n) => Math.abs(n.z) < 0.7);
    if (!upright) return { azimuth: 24, elevation: 20 };
    return { azimuth: THREE.MathUtils.radToDeg(Math.atan2(upright.y, upright.x)) + 90 + 18, elevation: 12 };
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.isTurned ? this.draw() : this.home();  // all is still in view, unless somebody chose what is
  }

  /** Draws before the next repaint, once, however often it is asked. */
  draw() {
    this.pending ??= requestAnimationFrame(() => {
      this.pending = undefined;
      this.renderer.render(this.scene, this.camera);
      this.onDrawn?.();
    });
  }
}
