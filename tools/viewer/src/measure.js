// Quantities on the triangles that the page shows: normals and curvature.

/** Splits corners into those of the free surface and those of the wetted area (all corners on a solid). */
export function splitWetted(corners, contact, index) {
  let free = 0, end = corners.length;
  for (let k = 0; k < corners.length; k += 3) {
    const [a, b, c] = [corners[k], corners[k + 1], corners[k + 2]];
    const at = contact[a] && contact[b] && contact[c] ? (end -= 3) : (free += 3) - 3;
    index[at] = a;
    index[at + 1] = b;
    index[at + 2] = c;
  }
  return free;
}

/** Adds the cross product of two edges (twice the area, outward) to each corner's normal. */
export function addNormals(positions, corners, begin, end, normals) {
  for (let k = begin; k < end; k += 3) {
    const a = 3 * corners[k], b = 3 * corners[k + 1], c = 3 * corners[k + 2];
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1], uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a], vy = positions[c + 1] - positions[a + 1], vz = positions[c + 2] - positions[a + 2];
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    for (const v of [a, b, c]) {
      normals[v] += nx;
      normals[v + 1] += ny;
      normals[v + 2] += nz;
    }
  }
}

/** K = kappa_1 + kappa_2 (1/cm) at each vertex, positive where convex: (L x . n) / M with cotangent weights and a
 *  third of the area of the faces around. 2/R on a sphere. */
export function curvature(positions, corners) {
  const n = positions.length;
  const flux = new Float64Array(n), normals = new Float64Array(n), area = new Float64Array(n / 3);
  addNormals(positions, corners, 0, corners.length, normals);
  const p = positions;
  for (let k = 0; k < corners.length; k += 3)
    for (let side = 0; side < 3; ++side) {  // a corner's cotangent weighs the edge opposite
      const o = corners[k + side], i = corners[k + (side + 1) % 3], j = corners[k + (side + 2) % 3];
      const ux = p[3 * i] - p[3 * o], uy = p[3 * i + 1] - p[3 * o + 1], uz = p[3 * i + 2] - p[3 * o + 2];
      const vx = p[3 * j] - p[3 * o], vy = p[3 * j + 1] - p[3 * o + 1], vz = p[3 * j + 2] - p[3 * o + 2];
      const twice = Math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx);
      area[o] += twice / 6;
      const weight = twice > 0 ? 0.5 * (ux * vx + uy * vy + uz * vz) / twice : 0;
      for (let axis = 0; axis < 3; ++axis) {
        const difference = weight * (p[3 * i + axis] - p[3 * j + axis]);
        flux[3 * i + axis] += difference;
        flux[3 * j + axis] -= difference;
      }
    }
  return Float32Array.from(area, (m, v) => {
    const [x, y, z] = normals.subarray(3 * v, 3 * v + 3);
    const length = Math.hypot(x, y, z);
    return m > 0 && length > 0 ? (flux[3 * v] * x + flux[3 * v + 1] * y + flux[3 * v + 2] * z) / (m * length) : 0;
  });
}
