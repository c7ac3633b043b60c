import * as THREE from "three";

export const backdrop = new THREE.Color(0xdce5ea);

/** What the liquid mirrors and bends: a bright room with two windows, a dark floor line and a dark strip. Made in code. */
export function makeEnvironment(renderer) {
  const room = new THREE.Scene();
  const dome = new THREE.Mesh(new THREE.SphereGeometry(10, 48, 32), new THREE.ShaderMaterial({
    side: THREE.BackSide,
    vertexShader: "varying vec3 d; void main() { d = position; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.); }",
    fragmentShader: `varying vec3 d;
      void main() {
        float h = normalize(d).z;
        vec3 sky = mix(vec3(.62, .72, .78), vec3(.95, 1., 1.05), smoothstep(0., .8, h));
        vec3 ground = mix(vec3(.34, .37, .38), vec3(.62, .64, .64), smoothstep(0., -.9, h));
        gl_FragColor = vec4(mix(ground, sky, smoothstep(-.06, .03, h)), 1.);
      }`,
  }));
  room.add(dome);
  const panel = (light, size, azimuth, elevation) => {
    const mesh = new THREE.Mesh(new THREE.PlaneGeometry(...size), new THREE.MeshBasicMaterial({ color: new THREE.Color().setScalar(light), side: THREE.DoubleSide }));
    mesh.position.copy(direction(azimuth, elevation).multiplyScalar(8));
    mesh.lookAt(0, 0, 0);
    room.add(mesh);
  };
  panel(9, [4, 5], -50, 48);  // windows
  panel(4, [3, 6], 115, 35);
  panel(0.06, [2.2, 7], 60, 12);  // dark strips, which draw the edges of clear things
  panel(0.06, [2.2, 7], -125, 12);
  const generator = new THREE.PMREMGenerator(renderer);
  const texture = generator.fromScene(room, 0.01).texture;
  generator.dispose();
  return texture;
}

/** The unit vector towards an azimuth (degrees from -y, counterclockwise seen from above) and an elevation. */
export function direction(azimuth, elevation) {
  const a = THREE.MathUtils.degToRad(azimuth - 90), e = THREE.MathUtils.degToRad(elevation);
  return new THREE.Vector3(Math.cos(a) * Math.cos(e), Math.sin(a) * Math.cos(e), Math.sin(e));
}

export const sunDirection = direction(-48, 52);

/** The sun: from the upper left, with a soft pale shadow. `radius` (cm) is of what it must cover. */
export function makeSun(center, radius) {
  const sun = new THREE.DirectionalLight(0xffffff, 1.6);
  sun.position.copy(center).addScaledVector(sunDirection, 4 * radius);
  sun.target.position.copy(center);
  sun.castShadow = true;
  sun.shadow.mapSize.set(1024, 1024);
  sun.shadow.intensity = 0.42;
  sun.shadow.radius = 5;
  sun.shadow.normalBias = 0.004 * radius;
  Object.assign(sun.shadow.camera, { left: -2 * radius, right: 2 * radius, top: 2 * radius, bottom: -2 * radius, near: 0.1 * radius, far: 9 * radius });
  return sun;
}
