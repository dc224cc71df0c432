// Builds the bundles from the pinned packages: `npm ci && npm run build` in this folder.
import { readFileSync, readdirSync, writeFileSync, existsSync, copyFileSync } from "node:fs";
import { build } from "esbuild";

const packages = new Set();
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
    const match = file.match(/node_modules\/((?:@[^/]+\/)?[^/]+)\//);
    if (match) packages.add(match[1]);
  }
}
copyFileSync("node_modules/uplot/dist/uPlot.min.css", "uPlot.css");

const licences = [...packages].sort().map((name) => {
  const folder = `node_modules/${name}`;
  const manifest = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
  const file = readdirSync(folder).find((x) => /^licen[cs]e/i.test(x));
  const text = file ? readFileSync(`${folder}/${file}`, "utf8").trim() : `(${manifest.license})`;
  return `${name} ${manifest.version} (${manifest.license})\n\n${text}\n`;
});
writeFileSync("LICENSES.txt", licences.join(`\n${"-".repeat(80)}\n\n`));
if (!existsSync("view.js")) throw new Error("no bundle was made");
