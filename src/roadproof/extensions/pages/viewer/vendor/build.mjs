// Makes the bundles again from the pinned packages: `npm ci && npm run build` in this folder.
import { readFileSync, readdirSync, writeFileSync, existsSync, copyFileSync } from "node:fs";
import { build } from "esbuild";

const pages = new Set();
for (const name of ["view", "edit"]) {
  const made = await build({
    entryPoints: [`${name}.entry.js`],
    bundle: true,
    format: "esm",
    minify: true,
    legalComments: "none",
    metafile: true,
    outfile: `${name}.js`,
    target: "es2022",
  });
  for (const file of Object.keys(made.metafile.inputs)) {
    const found = file.match(/node_modules\/((?:@[^/]+\/)?[^/]+)\//);
    if (found) pages.add(found[1]);
  }
}
copyFileSync("node_modules/uplot/dist/uPlot.min.css", "uPlot.css");

const licences = [...pages].sort().map((name) => {
  const folder = `node_modules/${name}`;
  const said = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
  const file = readdirSync(folder).find((x) => /^licen[cs]e/i.test(x));
  const text = file ? readFileSync(`${folder}/${file}`, "utf8").trim() : `(${said.license})`;
  return `${name} ${said.version} (${said.license})\n\n${text}\n`;
});
writeFileSync("LICENSES.txt", licences.join(`\n${"-".repeat(80)}\n\n`));
if (!existsSync("view.js")) throw new Error("no bundle was made");
