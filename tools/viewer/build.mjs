// node build.mjs NODE_MODULES OUT.cpp [PAGE.html]: bundles the page and writes it as the C++ source that the program
// is linked with: three pieces, between which the scene and the blocks go. PAGE.html is the page without data, for tests.
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const [modules, output, page] = process.argv.slice(2);
const { build } = createRequire(join(resolve(modules), "x.js"))("esbuild");

const bundle = async (entry) => {
  const result = await build({
    entryPoints: [join(here, "src", entry)], bundle: true, minify: true, write: false, format: "iife", target: "es2022",
    legalComments: "inline", nodePaths: [resolve(modules)],
  });
  return result.outputFiles[0].text;
};
const script = (await bundle("main.js")).replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
const style = await bundle("style.css");
const html = readFileSync(join(here, "page.html"), "utf8").replace("@@STYLE@@", () => style.trim()).replace("@@SCRIPT@@", () => script);
const pieces = html.split(/@@SCENE@@|@@BLOCKS@@/);
if (pieces.length !== 3) throw new Error("page.html must name the scene and the blocks once each");

/** A C++ string, cut where compilers have their limit. */
const literal = (text) => {
  const parts = [];
  for (const part of text.match(/[^]{1,12000}/gu)) parts.push(`    text += R"page(${part})page";\n`);
  if (text.includes(')page"')) throw new Error("the page holds the end of a C++ string");
  return `  {\n    std::string text;\n${parts.join("")}    page.push_back(std::move(text));\n  }\n`;
};
writeFileSync(output, `// Made by tools/viewer/build.mjs.
#include <string>
#include <utility>
#include <vector>
namespace meniscus::tools {
std::vector<std::string> page_pieces();
std::vector<std::string> page_pieces() {
  std::vector<std::string> page;
${pieces.map(literal).join("")}  return page;
}
}  // namespace meniscus::tools
`);
if (page) writeFileSync(page, pieces.join(""));
