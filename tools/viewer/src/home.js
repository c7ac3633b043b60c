import * as THREE from "three";
import { boundsOf } from "./page_data.js";

const boxOf = ({ min, max }) => new THREE.Box3(new THREE.Vector3(...min), new THREE.Vector3(...max));

/** The box (cm) of the liquid in all frames. */
export const boxOfLiquid = (scene) => boxOf(scene.bounds);

/** What is seen at first: all frames, but of liquid that falls far from bodies and sources only what is within half of their size. */
export function homeOf(scene, bodies) {
  const all = boxOfLiquid(scene), near = new THREE.Box3();
  for (const { object } of bodies) near.expandByObject(object);
  if (near.isEmpty()) return all;
  const first = scene.frames[0];
  if (first.vertices > 0) near.union(boxOf(boundsOf(first)));
  const home = near.expandByScalar(near.getSize(new THREE.Vector3()).length() / 2).intersect(all);
  return home.isEmpty() ? all : home;
}
