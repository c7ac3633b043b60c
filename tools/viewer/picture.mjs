// node picture.mjs NODE_MODULES PAGE.html OUT.png [--size=WxH] [HASH]: a picture of a page that `meniscus view` wrote, as
// Chromium draws it. HASH is as the page takes it: frame=12&look=speed&azimuth=30&elevation=10&zoom=2.
import { openBrowser, openPage } from "./browser.mjs";

const args = process.argv.slice(2);
const size = args.find((a) => a.startsWith("--size="))?.slice(7).split("x").map(Number) ?? [800, 600];
const [modules, page, output, hash = ""] = args.filter((a) => !a.startsWith("--size="));
const browser = await openBrowser(modules, size);
try {
  const tab = await openPage(browser, page, `bare&${hash}`);
  await tab.screenshot({ path: output });
} finally {
  await browser.close();
}
