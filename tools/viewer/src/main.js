import * as THREE from "three";
import { Frames } from "./frames.js";
import { homeOf } from "./home.js";
import { Liquid } from "./liquid.js";
import { Blocks, PageError, readScene } from "./page_data.js";
import { Player } from "./player.js";
import { makeBodies, makePlanes, makeSources } from "./solids.js";
import { Stage } from "./stage.js";

const $ = (id) => document.getElementById(id);

/** "#frame=12&look=speed&azimuth=30&elevation=10&zoom=2&target=0,0,1&wireframe&solids=0&bare": how the page opens. */
function openingOf(hash) {
  const given = new URLSearchParams(hash.slice(1));
  const value = (name) => (given.has(name) && Number.isFinite(Number(given.get(name))) ? Number(given.get(name)) : undefined);
  return {
    frame: value("frame") ?? 0, look: given.get("look") ?? "water", wireframe: given.has("wireframe"), bare: given.has("bare"),
    solids: given.get("solids") !== "0",
    view: { azimuth: value("azimuth"), elevation: value("elevation"), zoom: value("zoom"), target: given.get("target")?.split(",").map(Number) },
  };
}

function fail(error) {
  const known = error instanceof PageError;
  $("message").textContent = known ? error.message : `This page has failed: ${error?.message ?? error}`;
  document.body.dataset.state = "error";
}

/** Slower than life where the whole run would be over in a moment. */
function usualRate(seconds) {
  const rates = [1, 0.5, 0.25, 0.1, 0.05, 0.02, 0.01];
  return { rates, rate: rates.find((rate) => seconds / rate >= 3) ?? rates.at(-1) };
}

async function open() {
  const scene = readScene();
  const opening = openingOf(location.hash);
  const blocks = new Blocks(scene.blocks);
  const frames = new Frames(scene, blocks);
  const first = Math.min(Math.max(Math.round(opening.frame), 0), scene.frames.length - 1);
  await frames.get(first);  // damage shows before the light is made, which takes seconds without a graphics card
  const bodies = [...await makeBodies(scene, blocks), ...makeSources(scene)];
  const box = homeOf(scene, bodies);
  const center = box.getCenter(new THREE.Vector3()), radius = Math.max(box.getSize(new THREE.Vector3()).length() / 2, 1e-6);
  const normals = scene.solids.filter((solid) => solid.shape === "plane").map((solid) => new THREE.Vector3(...solid.normal).normalize());
  const stage = new Stage($("view"), center, radius, normals);
  const liquid = new Liquid(scene);
  const solids = [...makePlanes(scene, center, radius), ...bodies];
  stage.add(liquid.object, liquid.materials);
  for (const { object } of solids) stage.add(object, [object.material]);

  let newest = 0;
  const show = async (number) => {
    const ticket = ++newest;
    const start = performance.now();
    const surface = await frames.get(number);
    if (ticket !== newest) return;  // overtaken
    const frame = scene.frames[number];
    const legend = liquid.show(surface, frame, $("look").value);
    performance.clearMeasures("unpack");  // the last one is enough
    performance.measure("unpack", { start, end: performance.now() });
    if ($("legend").innerHTML !== legend) $("legend").innerHTML = legend;
    $("legend").hidden = legend === "";
    for (const solid of solids) solid.move(frame.time);
    $("facts").textContent = [frame.name, scene.timed ? `${frame.time.toFixed(4)} s` : "", `${frame.triangles.toLocaleString("en")} triangles`].filter(Boolean).join(" · ");
    shown = number;
    stage.draw();
    if (player.playing) for (let k = 1; k <= 4; ++k) frames.get((number + k * stride()) % scene.frames.length).catch(() => {});
  };
  const player = new Player(scene.frames, show);
  const span = scene.frames.at(-1).time - scene.frames[0].time;
  const stride = () => Math.max(1, Math.round(player.rate / 60 * player.last / (span || 1)));  // frames a repaint
  let shown = -1;
  stage.onDrawn = () => {
    document.body.dataset.frame = shown;  // what can be seen now
    if (shown >= 0) document.body.dataset.state = "ready";
  };
  const guarded = (promise) => promise.catch((error) => {
    player.toggle(false);
    fail(error);
  });

  const { rates, rate } = usualRate(span);
  if (scene.timed) {
    player.rate = rate;
    $("rate").replaceChildren(...rates.map((r) => new Option(r === 1 ? "real time" : `1/${Math.round(1 / r)}`, r, false, r === rate)));
  } else {
    $("rate").replaceChildren(...[0.5, 1, 5, 10, 30].map((r) => new Option(`${r} a second`, r, false, r === 1)));  // frame k is at k s
  }
  $("title").textContent = document.title = scene.title;
  $("scrub").max = player.last;
  $("look").value = [...$("look").options].some((option) => option.value === opening.look) ? opening.look : "water";
  $("wireframe").checked = opening.wireframe;
  $("solids").checked = opening.solids;
  document.body.classList.toggle("bare", opening.bare);
  document.body.classList.toggle("single", player.last === 0);

  player.onState = () => {
    $("scrub").value = player.frame;
    $("scrub").setAttribute("aria-valuetext", `frame ${player.frame} of ${player.last}`);
    $("clock").textContent = `${player.frame} / ${player.last}`;
    $("play").setAttribute("aria-pressed", player.playing);
    $("play").setAttribute("aria-label", player.playing ? "Pause" : "Play");
  };
  const seek = (number) => {
    player.toggle(false);
    guarded(player.seek(number));
  };
  const play = () => player.toggle();
  const redraw = () => {
    liquid.edges.visible = $("wireframe").checked;
    for (const solid of solids) solid.object.visible = $("solids").checked;
    guarded(show(player.frame));
  };
  $("play").addEventListener("click", play);
  $("scrub").addEventListener("input", () => seek(Number($("scrub").value)));
  $("rate").addEventListener("change", () => (player.rate = Number($("rate").value)));
  for (const id of ["look", "wireframe", "solids"]) $(id).addEventListener("change", redraw);
  $("home").addEventListener("click", () => stage.home());
  $("bar").addEventListener("submit", (event) => event.preventDefault());

  const keys = {
    " ": play, ArrowLeft: () => seek(player.frame - 1), ArrowRight: () => seek(player.frame + 1), Home: () => seek(0), End: () => seek(player.last),
    h: () => stage.home(), w: () => $("wireframe").click(), s: () => $("solids").click(),
    c: () => {
      $("look").selectedIndex = ($("look").selectedIndex + 1) % $("look").length;
      redraw();
    },
  };
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || !keys[event.key]) return;
    if (event.target.matches("select, input[type=range]") && event.key !== " ") return;  // they have keys of their own
    if (event.target.matches("button, input[type=checkbox]") && event.key === " ") return;
    event.preventDefault();
    keys[event.key]();
  });
  addEventListener("unhandledrejection", (event) => {
    event.preventDefault();
    player.toggle(false);
    fail(event.reason);
  });

  stage.home(opening.view);
  player.frame = first;
  player.time = scene.frames[player.frame].time;
  player.onState();
  redraw();
  $("message").textContent = "";
}

$("message").textContent = "Loading...";
addEventListener("DOMContentLoaded", () => open().catch(fail));
