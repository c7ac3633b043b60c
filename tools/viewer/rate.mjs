// node rate.mjs NODE_MODULES PAGE.html: how long the page takes to unpack each of its frames for the graphics card, and to
// show some of them one after another where there is none (Chromium draws in software; most of that is the shadow).
import { openBrowser, openPage } from "./browser.mjs";

const [modules, page] = process.argv.slice(2), drawn = 20;
const browser = await openBrowser(modules, [800, 600]);
try {
  const tab = await openPage(browser, page, "bare&look=shaded");
  const times = await tab.evaluate(async (count) => {
    const scrub = document.getElementById("scrub"), last = Number(scrub.max), unpacked = [], shown = [];
    const input = (frame) => ((scrub.value = frame), scrub.dispatchEvent(new Event("input")));
    const wait = () => new Promise((done) => setTimeout(done, 0));
    for (let frame = last; frame > 0; --frame) {
      performance.clearMeasures();
      input(frame);
      while (performance.getEntriesByName("unpack").length === 0) await wait();
      unpacked.push(performance.getEntriesByName("unpack")[0].duration);
    }
    for (let frame = 1; frame <= Math.min(count, last); ++frame) {
      const start = performance.now();
      input(frame);
      while (document.body.dataset.frame !== String(frame)) await wait();
      shown.push(performance.now() - start);
    }
    return { unpacked, shown };
  }, drawn);
  for (const [what, list] of Object.entries(times)) {
    list.sort((a, b) => a - b);
    const at = (share) => list[Math.floor(share * (list.length - 1))].toFixed(1);
    console.log(`${what}: ${list.length} frames, median ${at(0.5)} ms, 9 of 10 within ${at(0.9)} ms, longest ${at(1)} ms`);
  }
} finally {
  await browser.close();
}
