// What is asked of a fit: figures, a proof, studies.

/**
 * Pictures of the program.
 * @param {{name: string, svg: string, caption: string}[]} list
 * @param {string} stem
 */
function figures(list, stem) {
  $("found").replaceChildren(h("h2", {}, "Figures"), ...list.flatMap((one) => pictures(one.svg, `${stem}-${one.name}`, one.caption)));
}

/**
 * A picture, and how it is taken along.
 * @param {string} svg
 * @param {string} name
 * @param {string} caption
 */
function pictures(svg, name, caption) {
  const url = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
  return [
    h("figure", {}, h("img", { src: url, alt: caption, onload: () => URL.revokeObjectURL(url) }), h("figcaption", { class: "note" }, caption)),
    h("div", { class: "row" },
      h("button", { type: "button", class: "small", onclick: () => save(`${name}.svg`, svg, "image/svg+xml") }, `${name}.svg`),
      h("button", { type: "button", class: "small", onclick: later(async () => save(`${name}.png`, await png(svg), "image/png")) }, `${name}.png`)),
  ];
}

/** @param {SoFar} so_far */
const soFar = ({ eps, boxes, open }) => `${eps < 0.99 ? `proved within ${digits(100 * eps, 3)} % so far, ` : ""}${boxes} boxes, ${open} to go`;

/**
 * Proves that no parameters fit better, or finds those that do; a proof that is stopped tells how far it came.
 * @param {Subject} of
 * @param {string} stem
 * @param {string} percent
 * @param {number} seconds
 */
async function certify(of, stem, percent, seconds) {
  const what = `Proof within ${percent} %`;
  /** @type {SoFar | null} */
  let last = null;
  bridge.told = (so_far) => { last = so_far; doing.step = `${what}: ${soFar(so_far)}`; };
  const line = (/** @type {string[]} */ ...limit) => commandLine("certify", of, ["--within", `${percent}%`, ...limit, "--format", "json"]);
  try {
    const found = await doing(what, () => bridge.ask({ certify: { within: Number(percent) / 100, seconds } }, of));
    const { certificate } = JSON.parse(found.json);
    const limit = certificate === null ? ["--proof-seconds", String(seconds)] : certificate.complete ? [] : ["--proof-boxes", String(certificate.boxes)];
    showFound(what, `${stem}-proof`, found, line(...limit));
  } catch (error) {
    if (error instanceof Stopped && last) showFound(what, `${stem}-proof`, { text: `Stopped: ${soFar(last)}.` }, line("--proof-boxes", String(/** @type {SoFar} */ (last).boxes)));
    throw error;
  } finally { bridge.told = () => {}; }
}

/**
 * What a further study found, and the line for the program that finds the same.
 * @param {string} what
 * @param {string} stem
 * @param {{text: string, json?: string, svg?: string}} found
 * @param {string} line
 */
function showFound(what, stem, { text, json, svg }, line) {
  $("found").replaceChildren(h("h2", {}, what), ...(svg ? pictures(svg, stem, what) : []), h("pre", { class: "wide", tabindex: 0 }, text), h("pre", {}, line),
    h("div", { class: "row" }, json ? h("button", { type: "button", class: "small", onclick: () => save(`${stem}.json`, json, "application/json") }, `${stem}.json`) : null));
}

/**
 * Profiles, models, proof and convergence.
 * @param {NonNullable<typeof state.fit>} fit
 */
function showFurther(fit) {
  const { subject: of, result } = fit;
  const stem = of.files[0].replace(/\.[^.]*$/, "");
  const free = Object.entries(result.provenance.bounds).filter(([name, bounds]) => bounds[0] < bounds[1] && result.uncertainty.stderr[name] !== undefined).map(([name]) => name);
  const parameter = h("select", { "aria-label": "Parameter" }, ...free.map((name) => h("option", {}, name)));
  const seeds = h("input", { type: "number", min: 1, max: 1000, value: 3, style: "width:5rem", "aria-label": "Seeds" });
  const within = h("input", { type: "number", min: 0.1, max: 99, step: "any", value: 5, style: "width:5rem", "aria-label": "Part, %" });
  const limit = h("input", { type: "number", min: 0.1, step: "any", value: 60, style: "width:5rem", "aria-label": "Longest time, s" });
  const show = async (/** @type {string} */ what, /** @type {string} */ name, /** @type {any} */ want, /** @type {string} */ line) =>
    showFound(what, `${stem}-${name}`, await doing(what, () => bridge.ask(want, of)), line);
  const { seed, model, terms } = of.search;
  const some = (/** @type {Record<string, any>} */ options) => Object.fromEntries(Object.entries(options).filter(([, value]) => value !== undefined));
  $("further").replaceChildren(
    h("div", { class: "row" }, h("label", {}, "Parameter ", parameter), h("button", { type: "button", onclick: later(() =>
      show(`Profile of ${parameter.value}`, `profile-${parameter.value}`, { profile: { parameters: [parameter.value] } }, commandLine("profile", of, ["--parameter", parameter.value, "--format", "json"]))) }, "Profile")),
    h("div", { class: "row" }, h("button", { type: "button", onclick: later(() =>
      show("Comparison of models", "models", { compare: { models: "auto" } }, commandLine("compare", { ...of, search: some({ seed }) }, ["--format", "json"]))) }, "Compare all models")),
    h("div", { class: "row" }, h("label", {}, "Within ", within, " %, in at most ", limit, " s"), h("button", { type: "button", onclick: later(() => {
      if (!within.checkValidity() || !limit.checkValidity() || within.value === "" || limit.value === "") throw new Told("a proof needs a part in % and a time in s");
      return certify(of, stem, within.value, Number(limit.value));
    }) }, "Prove the optimum")),
    h("div", { class: "row" }, h("label", {}, "Seeds ", seeds), h("button", { type: "button", onclick: later(() => {
      const count = Math.min(Math.max(Math.round(Number(seeds.value)) || 3, 1), 1000);
      return show("Error against run time", "converge", { converge: { seeds: count } }, commandLine("converge", { ...of, search: some({ model, terms }) }, ["--seeds", String(count), "--format", "json"]));
    }) }, "Error against run time")));
}
