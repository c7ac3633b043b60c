// The page in real Chromium: MENISCUS (the program), NODE_MODULES and VIEWER (tools/viewer) say where things are.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { after, before, test } from "node:test";

const { openBrowser, settled } = await import(pathToFileURL(join(process.env.VIEWER, "browser.mjs")));
const meniscus = (...args) => execFileSync(process.env.MENISCUS, args, { stdio: ["ignore", "pipe", "pipe"] });

const directory = mkdtempSync(join(tmpdir(), "meniscus_page_"));
const inside = (name) => join(directory, name);
// Opening a page takes seconds where no graphics card helps, so tests share the tab of the run and that of the meshes.
let browser, pixels, run, meshes;

before(async () => {
  writeFileSync(inside("scene.json"), JSON.stringify({
    time_step: 0.001, frames: 20, steps_per_frame: 2, mesh: { edge_min: 0.03, edge_max: 0.09 },
    solids: [{ name: "plate", shape: "plane" }, { shape: "sphere", center: [0.5, 0, 0.1], radius: 0.1, velocity: [0, 0, 10] }],
    drops: [{ shape: "sphere", center: [0, 0, 0.25], radius: 0.2, velocity: [0, 0, -30] }],
  }));
  meniscus("evolve", inside("scene.json"), "-o", inside("run"), "-q");
  meniscus("view", inside("run"), "--html", inside("run.html"), "-q");
  browser = await openBrowser(process.env.NODE_MODULES, [400, 300]);
  pixels = await (await browser.newContext()).newPage();
  run = await open(inside("run.html"), "bare&frame=12");
});
after(async () => {
  await browser?.close();
  rmSync(directory, { recursive: true });
});

/** A tab with the page; what it must not do is kept in tab.faults. */
async function open(file, hash = "") {
  const tab = await browser.newPage({ viewport: browser.tabSize });
  tab.faults = [];
  tab.on("console", (message) => ["error", "warning"].includes(message.type()) && !/GPU stall|swiftshader/i.test(message.text()) && tab.faults.push(message.text()));
  tab.on("pageerror", (error) => tab.faults.push(String(error)));
  tab.on("request", (request) => /^(file|data|blob):/.test(request.url()) || tab.faults.push(`asks for ${request.url()}`));
  await tab.goto(`${pathToFileURL(file)}#${hash}`);
  await settled(tab);
  return tab;
}
const shows = (tab, frame) => tab.waitForFunction((f) => document.body.dataset.frame === String(f), frame, { timeout: 20000 });
const state = (tab) => tab.evaluate(() => document.body.dataset.state);
const message = (tab) => tab.locator("#message").textContent();
const picture = async (tab) => {
  await tab.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return (await tab.screenshot()).toString("base64");
};

/** Hides or shows all but the picture, as "#bare" does. */
const bare = (tab, is) => tab.evaluate((on) => document.body.classList.toggle("bare", on), is);
const choose = (tab, look) => tab.evaluate((value) => {
  const select = document.getElementById("look");
  select.value = value;
  select.dispatchEvent(new Event("change"));
}, look);

/** The standard deviation of brightness over a picture's middle, and the mean difference of two pictures, of 255. */
const statistics = (...pictures) => pixels.evaluate(async (all) => {
  const [one, two] = await Promise.all(all.map(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
    context.drawImage(image, 0, 0);
    return context.getImageData(image.width / 4, image.height / 4, image.width / 2, image.height / 2).data;
  }));
  let sum = 0, squares = 0, difference = 0;
  for (let k = 0; k < one.length; k += 4) {
    const grey = (one[k] + one[k + 1] + one[k + 2]) / 3;
    sum += grey;
    squares += grey * grey;
    if (two) difference += (Math.abs(one[k] - two[k]) + Math.abs(one[k + 1] - two[k + 1]) + Math.abs(one[k + 2] - two[k + 2])) / 3;
  }
  const n = one.length / 4;
  return { deviation: Math.sqrt(squares / n - (sum / n) ** 2), difference: difference / n };
}, pictures);

async function close(tab) {
  assert.deepEqual(tab.faults, []);
  await tab.close();
}

test("draws, and each look differently", async () => {
  const tab = run;
  await shows(tab, 12);
  assert.equal(await state(tab), "ready");
  assert.equal(await tab.locator("#message").isVisible(), false);
  const looks = {};
  for (const look of ["water", "shaded", "speed", "curvature", "drop", "contact"]) {
    await choose(tab, look);
    looks[look] = await picture(tab);
    assert.ok((await statistics(looks[look])).deviation > 4, `${look} is drawn`);
    assert.equal(await tab.locator("#legend").isVisible(), ["speed", "curvature", "contact"].includes(look));
  }
  const names = Object.keys(looks);
  for (let k = 1; k < names.length; ++k)
    assert.ok((await statistics(looks[names[k - 1]], looks[names[k]])).difference > 0.5, `${names[k - 1]} and ${names[k]} differ`);
  const click = () => tab.evaluate(() => document.getElementById("wireframe").click());
  await click();
  assert.ok((await statistics(looks.contact, await picture(tab))).difference > 0.3, "edges are drawn");
  await click();
  await bare(tab, false);
  assert.deepEqual(tab.faults, []);
});

test("plays, pauses, and scrubs by keys and by the slider", async () => {
  const tab = run;
  await choose(tab, "water");
  await tab.locator("#view").focus();
  await tab.keyboard.press("Home");
  await shows(tab, 0);
  const first = await picture(tab);
  await tab.keyboard.press("End");
  await shows(tab, 20);
  assert.ok((await statistics(first, await picture(tab))).difference > 0.5, "the last frame is another picture");
  await tab.keyboard.press("ArrowLeft");
  await shows(tab, 19);
  await tab.keyboard.press("Home");
  await shows(tab, 0);
  await tab.locator("#scrub").fill("7");
  await shows(tab, 7);
  assert.match(await tab.locator("#facts").textContent(), /0\.0140 s/);
  await tab.locator("#view").focus();
  await tab.keyboard.press(" ");
  assert.equal(await tab.locator("#play").getAttribute("aria-label"), "Pause");
  await tab.waitForFunction(() => Number(document.body.dataset.frame) > 8, null, { timeout: 20000 });
  await tab.keyboard.press(" ");
  assert.equal(await tab.locator("#play").getAttribute("aria-label"), "Play");
  assert.deepEqual(tab.faults, []);
});

test("turns by dragging, comes home, hides solids, fits a new size", async () => {
  const tab = run;
  await choose(tab, "shaded");
  await tab.locator("#scrub").fill("3");
  await shows(tab, 3);
  await tab.locator("#view").focus();
  const before = await picture(tab);
  await tab.mouse.move(200, 120);
  await tab.mouse.down();
  await tab.mouse.move(120, 150, { steps: 3 });
  await tab.mouse.up();
  assert.ok((await statistics(before, await picture(tab))).difference > 0.5, "another side");
  await tab.keyboard.press("h");
  assert.ok((await statistics(before, await picture(tab))).difference < 0.2, "home again");
  await tab.locator("#solids").uncheck();
  assert.ok((await statistics(before, await picture(tab))).difference > 0.5, "no solids");
  await tab.setViewportSize({ width: 500, height: 260 });
  await picture(tab);
  assert.deepEqual(await tab.evaluate(() => [document.getElementById("view").width, document.getElementById("view").height]), [500, 260]);
  await close(tab);
  run = undefined;
});

test("a solid that moves is elsewhere later", async () => {
  meniscus("convert", inside("run/frame_0000.ply"), inside("still.ply"));
  writeFileSync(inside("wait.json"), JSON.stringify({
    time_step: 1e-6, frames: 1, steps_per_frame: 1, gravity: [0, 0, 0],
    solids: [{ shape: "box", center: [0.6, 0, 0], size: [0.2, 0.2, 0.2], keys: [{ time: 0, position: [0, 0, 0] }, { time: 1e-6, position: [-0.1, 0, 0.3] }] }],
    drops: [{ mesh: "still.ply", translate: [0, 0, 1] }],
  }));
  meniscus("evolve", inside("wait.json"), "-o", inside("wait"), "-q");
  meniscus("view", inside("wait"), "--html", inside("wait.html"), "-q");
  const tab = await open(inside("wait.html"), "bare&target=0.5,0,0.1&zoom=1.2");
  const before = await picture(tab);
  await tab.keyboard.press("End");
  await shows(tab, 1);
  assert.ok((await statistics(before, await picture(tab))).difference > 0.5);
  await close(tab);
});

test("a drop that falls far leaves the view where the solid is", async () => {
  writeFileSync(inside("fall.json"), JSON.stringify({
    time_step: 0.001, frames: 1, steps_per_frame: 1, mesh: { edge_min: 0.03, edge_max: 0.09 }, gravity: [0, 0, 0],
    solids: [{ shape: "box", center: [0, 0, 0], size: [1, 1, 1] }],
    drops: [{ shape: "sphere", center: [1, 0, 0], radius: 0.2, velocity: [0, 0, -300000] }],
  }));
  meniscus("evolve", inside("fall.json"), "-o", inside("fall"), "-q");
  meniscus("view", inside("fall"), "--html", inside("fall.html"), "-q");
  const tab = await open(inside("fall.html"), "bare");
  assert.ok((await statistics(await picture(tab))).deviation > 10, "box and drop are large");
  await close(tab);
});

test("meshes are frames of their own, with their names", async () => {
  for (const frame of ["0000", "0020"]) meniscus("convert", inside(`run/frame_${frame}.ply`), inside(`m${frame}.off`));
  writeFileSync(inside("none.off"), "OFF\n0 0 0\n");
  meniscus("view", inside("none.off"), inside("m0000.off"), inside("m0020.off"), "--html", inside("meshes.html"), "-q");
  meshes = await open(inside("meshes.html"));
  for (const [number, name] of [[0, "none"], [1, "m0000"], [2, "m0020"]]) {
    await shows(meshes, number);
    assert.match(await meshes.locator("#facts").textContent(), new RegExp(`^${name}\\.off`));
    await meshes.keyboard.press("ArrowRight");
  }
  assert.deepEqual(meshes.faults, []);
});

test("no drops in a frame is a picture of the solids", async () => {
  assert.equal(await state(meshes), "ready");
  await meshes.keyboard.press("End");
  await shows(meshes, 2);
  await bare(meshes, true);
  const drop = await picture(meshes);
  await meshes.keyboard.press("Home");
  await shows(meshes, 0);
  assert.ok((await statistics(drop, await picture(meshes))).difference > 0.5, "the drop is gone");
  await close(meshes);
});

test("a damaged file says so, wherever it was hit", async () => {
  const page = readFileSync(inside("run.html"), "utf8");
  const blocks = page.lastIndexOf('id="blocks"'), scene = page.indexOf('id="scene"');
  const middle = blocks + 400;
  const other = page[middle] === "A" ? "B" : "A";
  const cases = {
    "cut in the script": page.slice(0, page.indexOf("<script>") + 5000),
    "cut before the scene": page.slice(0, scene - 20),
    "cut in the scene": page.slice(0, scene + 200),
    "cut in the blocks": page.slice(0, middle),
    "cut in the last block": page.slice(0, page.length - 200),
    "a letter changed": page.slice(0, middle) + other + page.slice(middle + 1),
    "no frames": page.slice(0, scene) + 'id="scene">{"format":1,"frames":[],"solids":[],"blocks":0}</script></body></html>',
    "no scene": page.slice(0, scene) + 'id="scene"></script></body></html>',
    "not JSON": page.slice(0, scene) + 'id="scene">{"format":1,</script></body></html>',
  };
  for (const [name, html] of Object.entries(cases)) {
    writeFileSync(inside("damaged.html"), html);
    const tab = await browser.newPage({ viewport: browser.tabSize });
    const faults = [];
    tab.on("pageerror", (error) => faults.push(String(error)));
    await tab.goto(`${pathToFileURL(inside("damaged.html"))}`);
    if (name !== "cut in the script") await settled(tab);  // there only the text that is always there speaks
    assert.notEqual(await state(tab), "ready", name);
    assert.ok(await tab.locator("#message").isVisible(), name);
    assert.match(await message(tab), /damaged|incomplete|no frames|no drops/i, name);
    assert.deepEqual(faults, [], name);
    await tab.close();
  }
});
