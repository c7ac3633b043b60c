// Headless Chromium for the tests and the pictures.
import { existsSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const flags = ["--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync", "--hide-scrollbars"];

/** A browser whose tabs have `size` pixels. Chromium is the system's, or $CHROMIUM. */
export async function openBrowser(modules, size = [800, 600]) {
  const { chromium } = createRequire(join(resolve(modules), "x.js"))("playwright-core");
  const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
  if (!existsSync(executablePath)) throw new Error(`${executablePath}: no browser there; install Debian's chromium, or name one in CHROMIUM`);
  const browser = await chromium.launch({ executablePath, headless: true, args: flags });
  browser.tabSize = { width: size[0], height: size[1] };
  return browser;
}

/** A tab with a page from the disk; returns when a frame is drawn, or throws with what the page says. */
export async function openPage(browser, file, hash = "") {
  const tab = await browser.newPage({ viewport: browser.tabSize });
  await tab.goto(`${pathToFileURL(resolve(file))}#${hash}`);
  await settled(tab);
  const state = await tab.evaluate(() => document.body.dataset.state);
  if (state === "error") throw new Error(`${file}: ${await tab.locator("#message").textContent()}`);
  return tab;
}

/** Until the page shows a frame or a message. */
export const settled = (tab) => tab.waitForFunction(() => document.body.dataset.state !== "loading", null, { timeout: 60000 });
