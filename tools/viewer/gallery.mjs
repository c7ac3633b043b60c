// node gallery.mjs MENISCUS NODE_MODULES [NAME...]: see scripts/gallery. Runs in the project's root.
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { openBrowser, openPage } from "./browser.mjs";

/** The pictures: a scene of data/scenes, how many frames of it to run, and how to look at which frame. */
const shots = [
  { name: "splash_falling", scene: "splash", frames: 120, look: "frame=7&zoom=1.2", text: "falls" },
  { name: "splash_spreading", scene: "splash", frames: 120, look: "frame=11&zoom=0.8", text: "spreads" },
  { name: "splash_rest", scene: "splash", frames: 120, look: "frame=120&zoom=0.8", text: "rests" },
  { name: "bar", scene: "bar", frames: 120, look: "frame=6&zoom=1.2", text: "a bar pulls itself together (Fig 4)" },
  { name: "resting_60", scene: "resting_60", frames: 60, look: "frame=60&elevation=6", text: "60 degrees (Fig 2)" },
  { name: "resting_90", scene: "resting_90", frames: 60, look: "frame=60&elevation=6", text: "90 degrees (Fig 2)" },
  { name: "resting_120", scene: "resting_120", frames: 60, look: "frame=60&elevation=6", text: "120 degrees (Fig 2)" },
  { name: "collide_meeting", scene: "collide", frames: 120, look: "frame=25&zoom=1.2", text: "two drops collide: they have met (Fig 6)" },
  { name: "collide_waves", scene: "collide", frames: 120, look: "frame=70&zoom=1.2", text: "and have become one (Fig 6)" },
  { name: "spreading", scene: "spreading", frames: 240, look: "frame=120&elevation=20", text: "a highly hydrophilic plate (Fig 7)" },
  { name: "tension_low", scene: "tension_low", frames: 240, look: "frame=200&elevation=6", text: "low tension (Fig 8)" },
  { name: "tension_high", scene: "tension_high", frames: 240, look: "frame=200&elevation=6", text: "high tension (Fig 8)" },
  { name: "tap_low", scene: "tap_low", frames: 96, look: "frame=32&elevation=0&target=0,0,-4&zoom=0.1", text: "a tap, tension 8 (Fig 9)" },
  { name: "tap_middle", scene: "tap_middle", frames: 96, look: "frame=32&elevation=0&target=0,0,-4&zoom=0.1", text: "tension 30 (Fig 9)" },
  { name: "tap_high", scene: "tap_high", frames: 96, look: "frame=32&elevation=0&target=0,0,-4&zoom=0.1", text: "tension 72 (Fig 9)" },
  { name: "pane", scene: "pane", frames: 150, look: "frame=40&azimuth=150&elevation=10&target=0,0,-1&zoom=3.2", text: "a window pane: small drops stick, large ones run (Fig 10)" },
  { name: "pane_button", scene: "pane", frames: 150, look: "frame=130&azimuth=150&elevation=10&target=0,0,2&zoom=2.9", text: "and a button is drawn over it (Fig 10)" },
  { name: "bird", scene: "bird", frames: 120, look: "frame=40&elevation=0&azimuth=50&target=0,0,0&zoom=1.7", text: "drops run down a bird and hang from it (Fig 11)" },
  { name: "lotus", scene: "lotus", frames: 140, look: "frame=70&elevation=25&target=0.4,-0.5,0.3&zoom=2.1", text: "drops on lotus leaves (Fig 12)" },
];
const columns = 3, sheet = "docs/gallery/sheet.png";

const [meniscus, modules, ...names] = process.argv.slice(2);
const wanted = shots.filter((shot) => names.length === 0 || names.includes(shot.name) || names.includes(shot.scene));
for (const name of names) if (!shots.some((shot) => [shot.name, shot.scene].includes(name))) throw new Error(`no picture is called ${name}`);
mkdirSync("docs/gallery", { recursive: true });

/** Runs a scene unless it was, and writes its page. */
function page({ scene, frames }) {
  const run = join("out/gallery", scene), html = `${run}.html`;
  if (!existsSync(join(run, "run.json"))) {
    console.log(`running ${scene}`);
    execFileSync(meniscus, ["evolve", `data/scenes/${scene}.json`, "-o", run, "--frames", String(frames), "-q"], { stdio: "inherit" });
  }
  execFileSync(meniscus, ["view", run, "--html", html, "-q"], { stdio: "inherit" });
  return html;
}

/** All pictures that are there, small, with a line of text each. */
function sheetPage() {
  const shown = shots.filter(({ name }) => existsSync(`docs/gallery/${name}.png`));
  const figures = shown.map(({ name, text }) => `<figure><img src="data:image/png;base64,${readFileSync(`docs/gallery/${name}.png`).toString("base64")}"><figcaption>${text}</figcaption></figure>`);
  return { html: `<!doctype html><style>body { margin: 0; padding: 6px; width: ${columns * 316}px; box-sizing: border-box; background: #fff; display: grid; gap: 6px;
    grid-template-columns: repeat(${columns}, 1fr); font: 13px system-ui, sans-serif; color: #1d2b33; } figure { margin: 0; } img { width: 100%; display: block; }
    figcaption { padding: 3px 2px; }</style>${figures.join("")}`, count: shown.length };
}

const browser = await openBrowser(modules, [800, 600]);
try {
  const pages = new Map();
  for (const shot of wanted) {
    if (!pages.has(shot.scene)) pages.set(shot.scene, page(shot));
    const output = `docs/gallery/${shot.name}.png`;
    const tab = await openPage(browser, pages.get(shot.scene), `bare&${shot.look}`);
    await tab.screenshot({ path: output });
    await tab.close();
    console.log(`${output}: ${Math.round(statSync(output).size / 1024)} KB`);
  }
  const tab = await browser.newPage({ viewport: { width: columns * 316, height: 300 } });
  await tab.setContent(sheetPage().html);
  await tab.screenshot({ path: sheet, fullPage: true });
  console.log(`${sheet}: ${sheetPage().count} pictures, ${Math.round(statSync(sheet).size / 1024)} KB`);
} finally {
  await browser.close();
}
