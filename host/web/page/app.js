// The page: what is chosen, what is asked of the program, and what is shown.

/** Files larger than this do not fit into the memory of a page. */
const LARGEST = 400e6;

const FORMS = ["zemax", "zemax-abg", "fred", "glsl", "mitsuba", "mitsuba-native", "mitsuba-principled", "gltf", "materialx", "openpbr", "rgl", "c", "rust", "bird", "openmaterial"];
/** @type {Record<string, string>} */
const ENDINGS = { zemax: "bsdf", "zemax-abg": "dat", fred: "frs", glsl: "brdf", mitsuba: "py", "mitsuba-native": "py", "mitsuba-principled": "py", gltf: "gltf", materialx: "mtlx", openpbr: "mtlx", rgl: "bsdf", c: "h", rust: "rs", bird: "json", openmaterial: "xompt" };

/** @type {Bridge} */ let bridge;
/** @type {any} */ let about;
/** @type {Chart} */ let chart;
/** @type {Setting[]} */ let READ;
/** @type {Setting[]} */ let SEARCH;

const state = {
  /** @type {any[]} */ scans: [],
  current: 0,
  /** Places of samples of the current scan that were marked to be left out. @type {Set<number>} */ marked: new Set(),
  /** @type {{result: any, json: string, text: string, subject: any, seconds: number} | null} */ fit: null,
  /** Places of the minima that are drawn beside the best. @type {Set<number>} */ minima: new Set(),
  /** Counts what the user asked for: an answer to something older is not shown. */ turn: 0,
};

/**
 * Done when the last thing that was asked for is; tests wait for it.
 * @type {Promise<any>}
 */
let settled = Promise.resolve();

/**
 * Does something when it is asked for, and tells what goes wrong.
 * @param {() => any} act
 */
const later = (act) => () => { settled = (async () => { try { await act(); } catch (error) { tell(error); } })(); };

/** @typedef {{files: string[], read: Record<string, any>, search: Record<string, any>}} Subject */

/** Names of the files that the user gave. */
const given = () => [...bridge.files.keys()].filter((name) => !made.has(name));
/**
 * Names of files that the page made of marked samples.
 * @type {Set<string>}
 */
const made = new Set();

/** @param {unknown} error */
function tell(error) {
  if (error instanceof Stopped) return;
  $("error").textContent = error instanceof Error ? error.message : String(error);
}

/**
 * Shows that something is being done, and lets it be stopped.
 * @template T
 * @param {string} what
 * @param {() => Promise<T>} act
 * @returns {Promise<T>}
 */
async function doing(what, act) {
  const begun = performance.now();
  const clock = setInterval(() => {
    const seconds = (performance.now() - begun) / 1e3;
    if (seconds < 0.25) return;
    $("progress").hidden = false;
    $("stop").hidden = false;
    $("doing").textContent = `${doing.step || what}: ${seconds.toFixed(1)} s`;
  }, 100);
  try {
    const done = await act();
    const seconds = (performance.now() - begun) / 1e3;
    $("doing").textContent = `${what}: done in ${seconds < 1 ? `${Math.round(1e3 * seconds)} ms` : `${seconds.toFixed(1)} s`}; ${Math.round(bridge.memory / 2 ** 20)} MB`;
    return done;
  } catch (error) {
    $("doing").textContent = error instanceof Stopped ? `${what}: stopped` : `${what}: not done`;
    throw error;
  } finally {
    clearInterval(clock);
    doing.step = "";
    $("progress").hidden = true;
    $("progress").removeAttribute("value");
    $("stop").hidden = true;
  }
}
/** A step of what is being done. */
doing.step = "";

/**
 * How far it is.
 * @param {string} step
 * @param {number} part
 */
function progress(step, part) {
  doing.step = step;
  $("progress").value = part;
}

/** The bounds and fixed values that are given. */
function ranges() {
  /** @type {{bounds?: string[], fix?: string[]}} */
  const found = {};
  const [bounds, fix] = [[], []];
  for (const row of $("bound-fields").querySelectorAll("tr[data-name]")) {
    const [low, high, value] = [...row.querySelectorAll("input")].map((input) => input.value.trim());
    const name = row.dataset.name;
    if (value !== "") fix.push(/** @type {never} */ (`${name}=${value}`));
    else if (low !== "" || high !== "") bounds.push(/** @type {never} */ (`${name}=${low || row.dataset.lower}:${high || row.dataset.upper}`));
  }
  if (bounds.length) found.bounds = bounds;
  if (fix.length) found.fix = fix;
  return found;
}

/** A field of bounds for each parameter of the model. */
function boundFields() {
  const name = $("option-model").value;
  const one = about.models.find((/** @type {any} */ model) => model.name === (name || about.models[0].name));
  const models = one ? [one] : about.models;
  /** @type {Map<string, any>} */
  const parameters = new Map();
  for (const model of models) for (const parameter of model.parameters) if (!parameters.has(parameter.name)) parameters.set(parameter.name, parameter);
  const rows = [...parameters.values()].map((parameter) => {
    const field = (/** @type {string} */ what, /** @type {any} */ usual) => h("td", {}, h("input", { size: 7, "aria-label": `${what} of ${parameter.name}`, placeholder: usual, onchange: later(changedFit), autocomplete: "off", inputmode: "decimal" }));
    return h("tr", { "data-name": parameter.name, "data-lower": parameter.lower, "data-upper": parameter.upper },
      h("th", { scope: "row", class: "word", title: parameter.what }, parameter.name), field("least value", parameter.lower), field("largest value", parameter.upper), field("fixed value", "free"));
  });
  $("bound-fields").replaceChildren(table([["parameter", "word"], ["least"], ["largest"], ["fixed"]], rows, "Bounds and fixed values"));
  const terms = $("option-terms");
  terms.disabled = one !== undefined && one.terms.length === 0;
}

/**
 * The current scan as the program is asked for it: alone.
 * @returns {Subject}
 */
function subject() {
  const scan = state.scans[state.current];
  const read = chosen([...READ, ...MASKS]);
  const search = { ...chosen(SEARCH), ...ranges() };
  const files = given();
  const of = state.scans.filter((other) => other.files.join() === scan.files.join());
  if (of.length > 1 && scan.name !== null) read.column = [scan.name];
  if (!read["one-scan"] && read["theta-i"]?.length > 1) read["theta-i"] = [read["theta-i"][files.indexOf(scan.file)]];
  return { files: scan.files, read, search };
}

/**
 * The scan that is fitted: the current one, or a file without the samples that are marked.
 * @returns {Promise<Subject>}
 */
async function fittedSubject() {
  const of = subject();
  if (state.marked.size === 0) return of;
  const name = `${of.files[0].replace(/\.[^.]*$/, "")}-marked.csv`;
  const rows = await bridge.ask({ without: [...state.marked].sort((a, b) => a - b) }, { ...of, search: {} });
  made.add(name);
  bridge.take(name, new Blob([rows], { type: "text/csv" }));
  return { files: [name], read: {}, search: of.search };
}

/** Reads all files again. */
async function readAll() {
  const turn = ++state.turn;
  $("error").textContent = "";
  listFiles();
  const files = given();
  if (files.length === 0) { state.scans = []; showScans(); return; }
  try {
    const read = chosen([...READ, ...MASKS]);
    const scans = await doing("Reading", () => bridge.ask("read", { files, read, search: {} }));
    if (turn !== state.turn) return;
    const label = state.scans[state.current]?.label;
    state.scans = scans;
    state.current = Math.max(0, scans.findIndex((/** @type {any} */ scan) => scan.label === label));
    state.marked.clear();
    showScans();
  } catch (error) {
    if (turn !== state.turn) return;
    if (!(error instanceof Stopped)) { state.scans = []; showScans(); }
    tell(error);
    return;
  }
  await changedFit();
}

function listFiles() {
  $("file-list").replaceChildren(...given().map((name) => h("li", {}, h("span", {}, `${name} (${size(/** @type {Blob} */ (bridge.files.get(name)).size)})`),
    h("button", { type: "button", class: "small", "aria-label": `Remove ${name}`, onclick: later(() => { bridge.drop(name).catch(tell); return readAll(); }) }, "remove"))));
}

/** @param {number} bytes */
function size(bytes) {
  return bytes < 1e4 ? `${bytes} bytes` : bytes < 1e6 ? `${Math.round(bytes / 1e3)} kB` : `${(bytes / 1e6).toFixed(1)} MB`;
}

/** Shows the scans that were read. */
function showScans() {
  const { scans } = state;
  $("scan-row").hidden = scans.length < 2;
  $("scan").replaceChildren(...scans.map((scan, place) => h("option", { value: place }, scan.label)));
  $("scan").value = String(state.current);
  $("all").hidden = true;
  showScan();
}

/** Shows the current scan, without a fit. */
function showScan() {
  const scan = state.scans[state.current];
  state.fit = null;
  state.minima.clear();
  $("results").hidden = true;
  $("found").replaceChildren();
  $("read").hidden = !scan;
  $("read").replaceChildren(...(scan ? readView(scan) : []));
  $("canvas").setAttribute("aria-label", scan ? `${scan.label}: BRDF and residuals over the scattering angle; arrow keys go from sample to sample, plus and minus zoom, Home shows all` : "No scan is read");
  if (!scan) { chart.show(null, null); legend(); showMarks(); return; }
  const [kept, marked] = parted(scan.points, state.marked);
  chart.show(kept, joined(scan.left_out, marked));
  legend();
  showMarks();
}

/** @param {Points} points @param {Set<number>} marked @returns {[Points, Points]} those that stay, and those that are marked */
function parted(points, marked) {
  const pick = (/** @type {(k: number) => boolean} */ wanted) => /** @type {Points} */ (Object.fromEntries(Object.entries(points).map(([name, list]) => [name, /** @type {any[]} */ (list).filter((_, k) => wanted(k))])));
  return marked.size === 0 ? [points, pick(() => false)] : [pick((k) => !marked.has(k)), pick((k) => marked.has(k))];
}

/** @param {any} a @param {any} b @returns {Points} */
function joined(a, b) {
  return /** @type {Points} */ (Object.fromEntries(Object.keys(a).map((name) => [name, [...a[name], ...b[name]]])));
}

/** Angles of incidence with their colours; each can be hidden. */
function legend() {
  const { angles } = chart;
  $("legend").replaceChildren(...angles.map((angle, k) => {
    const box = h("input", { type: "checkbox", onchange: () => {
      if (box.checked) chart.hidden.delete(angle); else chart.hidden.add(angle);
      if (chart.zoomed) chart.draw(); else chart.reset();
    } });
    box.checked = !chart.hidden.has(angle);
    return h("label", {}, box, h("i", { style: `background:${colour(k, angles.length)}` }), `${digits(angle, 5)}°`);
  }));
}

/** Samples to leave out: by dragging, or by a range of scattering angles. */
function showMarks() {
  const scan = state.scans[state.current];
  if (!scan) { $("marks").replaceChildren(); return; }
  if (scan.stride > 1) { $("marks").replaceChildren(h("p", { class: "note" }, `One in ${scan.stride} samples is drawn, so that none can be marked.`)); return; }
  const from = h("input", { type: "number", step: "any", "aria-label": "scattering angle from, degrees" });
  const to = h("input", { type: "number", step: "any", "aria-label": "scattering angle to, degrees" });
  const range = () => {
    const [low, high] = [Number(from.value || -90), Number(to.value || 90)];
    const points = /** @type {Points} */ (chart.points);
    return mark(points.x.map((_, k) => k).filter((k) => points.x[k] >= low && points.x[k] <= high && !chart.hidden.has(points.theta_i[k])));
  };
  /** @type {Node[]} */
  const back = state.marked.size === 0 ? [] : [h("button", { type: "button", class: "small", onclick: later(() => { state.marked.clear(); showScan(); return changedFit(); }) }, "take them back")];
  $("marks").replaceChildren(
    h("div", { class: "row" }, h("label", {}, "Scattering ", from), h("label", {}, "to ", to, " °"), h("button", { type: "button", class: "small", onclick: later(range) }, "leave out")),
    h("p", { class: "note" }, state.marked.size === 0 ? "Or press Mark above the figure, and drag over samples. Hidden angles of incidence stay." : `${state.marked.size} samples are marked. They are left out of a file of its own, which the fit is of.`),
    ...back);
}

/**
 * Leaves samples out.
 * @param {number[]} places among those that are shown
 */
function mark(places) {
  const scan = state.scans[state.current];
  const stay = scan.points.x.map((/** @type {any} */ _, /** @type {number} */ k) => k).filter((/** @type {number} */ k) => !state.marked.has(k));
  if (places.length === 0 || scan.stride > 1) return;
  if (places.length >= stay.length) { tell(new Told("these are all samples: some must stay")); return; }
  for (const place of places) state.marked.add(stay[place]);
  const [x, y, zoomed] = [chart.x, chart.y, chart.zoomed];
  showScan();
  if (zoomed) Object.assign(chart, { x, y, zoomed });
  return changedFit();
}

/** Something about the fit changed: what is fast is done at once. */
async function changedFit() {
  if (state.scans.length === 0) return;
  const long = $("option-method").value !== "" || $("option-model").value === "auto" || /** @type {Points} */ (chart.points).x.length > 3e4;
  if (!long) await fitNow();
  else if (state.fit) $("doing").textContent = "This fit takes longer: press Fit for what is chosen now";
}

/** Fits the current scan and shows it. */
async function fitNow() {
  if (state.scans.length === 0) { tell(new Told("there is no scan yet")); return; }
  const turn = ++state.turn;
  $("error").textContent = "";
  try {
    const { of, answer } = await doing("Fit", async () => {
      const of = await fittedSubject();
      return { of, answer: await bridge.ask("fit", of) };
    });
    if (turn !== state.turn) return;
    state.fit = { ...answer, result: JSON.parse(answer.json), subject: of };
    state.minima.clear();
    $("results").hidden = false;
    $("found").replaceChildren();
    showFit();
    await drawFits(turn);
  } catch (error) {
    // What was finished before it was stopped stays.
    if (turn !== state.turn || error instanceof Stopped) return;
    state.fit = null;
    $("results").hidden = true;
    chart.fits = [];
    chart.draw();
    tell(error);
  }
}

/** @param {string} name */
const modelOf = (name) => about.models.find((/** @type {any} */ model) => model.name === name);

function showFit() {
  const fit = state.fit;
  if (!fit) return;
  const model = modelOf(fit.result.model);
  $("parameters").replaceChildren(...parametersView(fit.result, model, fit.seconds));
  $("minima").replaceChildren(...minimaView(fit.result, model, state.minima, (place) => {
    if (!state.minima.delete(place)) state.minima.add(place);
    showFit();
    /** @type {any} */ ($("minima").querySelectorAll("button")[place - 1])?.focus();
    drawFits(state.turn);
  }));
  showOut(fit);
}

/**
 * Curves of the best fit and of the minima that are chosen, for what the figure shows.
 * @param {number} turn
 */
async function drawFits(turn) {
  const fit = state.fit;
  if (!fit) return;
  const model = modelOf(fit.result.model);
  const [from, to] = chart.x;
  try {
    const fits = [];
    for (const place of [...state.minima, 0]) {
      const values = model.parameters.map((/** @type {any} */ one) => (place === 0 ? fit.result : fit.result.minima[place]).parameters[one.name]);
      fits.push({ drawn: await bridge.ask({ draw: { model: model.name, values, from, to } }, fit.subject), best: place === 0 });
    }
    if (turn !== state.turn) return;
    chart.fits = fits;
    chart.draw();
  } catch (error) { tell(error); }
}

/**
 * What leaves the page.
 * @param {NonNullable<typeof state.fit>} fit
 */
function showOut(fit) {
  const stem = fit.subject.files[0].replace(/\.[^.]*$/, "");
  const act = (/** @type {string} */ text, /** @type {() => any} */ does) => h("button", { type: "button", onclick: later(does) }, text);
  const line = commandLine("fit", fit.subject, ["--format", "json"]);
  const hashes = fit.result.provenance.files.map((/** @type {any} */ one) => `${one.sha256}  ${one.file}`).join("\n");
  const form = h("select", { "aria-label": "Form of the export" }, ...FORMS.map((one) => h("option", {}, one)));
  const length = h("input", { type: "number", min: 1, step: "any", style: "width:6rem", placeholder: "nm", "aria-label": "Wavelength in nm, for openmaterial and rgl" });
  const note = h("p", { class: "note text", "aria-live": "polite" });
  const file = state.marked.size > 0 ? act("Scan without marked samples (CSV)", () => save(fit.subject.files[0], /** @type {Blob} */ (bridge.files.get(fit.subject.files[0])), "text/csv")) : null;
  $("out").replaceChildren(
    h("div", { class: "row" },
      act("Report (HTML)", async () => save(`${stem}.html`, await doing("Report", () => bridge.ask({ report: { command: commandLine("report", fit.subject) } }, fit.subject)), "text/html")),
      act("JSON", () => save(`${stem}.json`, fit.json, "application/json")),
      act("CSV", async () => save(`${stem}-fit.csv`, await bridge.ask("csv", fit.subject), "text/csv")),
      act("Samples as read (CSV)", async () => save(`${stem}-read.csv`, await bridge.ask("table", fit.subject), "text/csv")),
      file,
      act("Figures", async () => figures(await doing("Figures", () => bridge.ask("figures", fit.subject)), stem))),
    h("div", { class: "row" }, h("label", {}, "For ", form), length, act("Export", async () => {
      const answer = await bridge.ask({ export: { to: form.value, wavelength: length.value === "" ? null : Number(length.value) } }, fit.subject);
      note.textContent = answer.note ?? "";
      save(`${stem}-${form.value}.${ENDINGS[form.value]}`, bytesOf(answer.hex), "application/octet-stream");
    })),
    note,
    h("p", {}, "The program gives the same bits with"),
    h("pre", { id: "command" }, line),
    h("div", { class: "row" }, act("Copy", () => navigator.clipboard.writeText(line))),
    h("p", {}, "of the file whose SHA-256 is"),
    h("pre", { id: "sha" }, hashes),
    h("details", {}, h("summary", {}, "JSON"), h("pre", { id: "json", class: "wide", tabindex: 0 }, fit.json)),
    h("details", {}, h("summary", {}, "As the program prints it"), h("pre", { class: "wide", tabindex: 0 }, fit.text)));
  showFurther(fit);
}

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

/** Fits every scan; what is done stays when it is stopped. */
async function fitAll() {
  const turn = ++state.turn;
  $("error").textContent = "";
  /** @type {{label: string, result: any, json: string, place: number}[]} */
  const all = [];
  /** @type {string[]} */
  const failed = [];
  const before = state.current;
  try {
    await doing("Fits of all scans", async () => {
      for (let place = 0; place < state.scans.length; place++) {
        progress(`Scan ${place + 1} of ${state.scans.length}`, place / state.scans.length);
        state.current = place;
        const of = subject();
        state.current = before;
        try {
          const answer = await bridge.ask("fit", of);
          all.push({ label: state.scans[place].label, json: answer.json, result: JSON.parse(answer.json), place });
        } catch (error) {
          if (!(error instanceof Told)) throw error;
          failed.push(error.message);
        }
        if (turn !== state.turn) throw new Stopped("stopped");
      }
    });
  } catch (error) { tell(error); }
  $("all").hidden = all.length === 0;
  $("all-table").replaceChildren(...allView(all, (row) => { state.current = all[row].place; $("scan").value = String(state.current); state.marked.clear(); showScan(); later(changedFit)(); }),
    h("div", { class: "row" }, h("button", { type: "button", onclick: () => save("fits.json", `[\n${all.map((one) => one.json.trimEnd().replace(/^/gm, "  ")).join(",\n")}\n]\n`, "application/json") }, "JSON of all"),
      h("span", { class: "note" }, `${all.length} of ${state.scans.length} scans are fitted.`)),
    ...failed.map((text) => h("p", { class: "hint text" }, text)));
}

/**
 * Takes files that were dropped or chosen.
 * @param {Iterable<File>} files
 */
async function take(files) {
  for (const file of files) {
    if (file.size > LARGEST) { tell(new Told(`${file.name} has ${size(file.size)}, and this page takes up to ${size(LARGEST)}; the program takes more`)); return; }
    bridge.take(file.name, file);
  }
  await readAll();
}

/** Buttons above the figure. */
function bar() {
  const button = (/** @type {string} */ text, /** @type {string} */ title, /** @type {() => void} */ act) => h("button", { type: "button", class: "small", title, onclick: act }, text);
  const log = button("Log axis", "Logarithmic or linear", () => { chart.log = !chart.log; log.setAttribute("aria-pressed", chart.log); chart.reset(); });
  const marks = button("Mark", "Drag over samples to leave them out", () => { chart.mode = chart.mode === "zoom" ? "mark" : "zoom"; marks.setAttribute("aria-pressed", chart.mode === "mark"); });
  log.setAttribute("aria-pressed", "true");
  marks.setAttribute("aria-pressed", "false");
  $("bar").replaceChildren(log, button("Zoom in", "Or drag over a part", () => chart.zoom(0.7)), button("Zoom out", "", () => chart.zoom(1 / 0.7)), button("Show all", "Or double-click", () => chart.reset()), marks,
    button("Picture", "This figure as PNG", () => $("canvas").toBlob((/** @type {Blob} */ blob) => save("figure.png", blob, "image/png"))));
}

async function begin() {
  chart = new Chart($("canvas"));
  let timer = 0;
  chart.onrange = () => { clearTimeout(timer); timer = setTimeout(() => drawFits(state.turn), 60); };
  chart.onvalue = (text) => { $("under").textContent = text || "Values under the cursor stand here."; };
  chart.onmark = (places) => later(() => mark(places))();
  bar();
  chart.draw();
  // The module is in the page itself.
  const packed = Uint8Array.from(atob($("wasm").textContent), (letter) => letter.charCodeAt(0));
  bridge = new Bridge(packed, Number($("wasm").dataset.size), $("worker").textContent);
  about = await bridge.ask("about");
  $("version").textContent = about.version;
  READ = readSettings(about);
  SEARCH = searchSettings(about);
  fields(READ, $("read-fields"), later(readAll));
  fields(MASKS, $("mask-fields"), later(readAll));
  fields(SEARCH, $("search-fields"), later((() => {
    let model = "";
    return () => {
      if ($("option-model").value !== model) { model = $("option-model").value; boundFields(); }
      return changedFit();
    };
  })()));
  boundFields();
  $("choose").onclick = () => $("files").click();
  $("files").onchange = () => {
    const files = [...$("files").files];
    later(() => take(files))();
    $("files").value = "";
  };
  $("example").onclick = later(() => take([new File([$("example-data").textContent], "example.csv", { type: "text/csv" })]));
  $("scan").onchange = later(() => { state.current = Number($("scan").value); state.marked.clear(); showScan(); return changedFit(); });
  $("fit").onclick = later(fitNow);
  $("fit-all").onclick = later(fitAll);
  $("stop").onclick = () => { bridge.restart(); };
  for (const kind of ["dragenter", "dragover"]) document.addEventListener(kind, (event) => { event.preventDefault(); $("drop").classList.add("over"); });
  for (const kind of ["dragleave", "drop"]) document.addEventListener(kind, (event) => { event.preventDefault(); $("drop").classList.remove("over"); });
  document.addEventListener("drop", (event) => {
    const files = [...(event.dataTransfer?.files ?? [])];
    if (files.length) later(() => take(files))();
  });
  $("doing").textContent = "Ready";
  document.documentElement.dataset.ready = "yes";
}

// After the first paint, as unpacking the module takes longer than that.
requestAnimationFrame(() => setTimeout(() => begin().catch((error) => { $("doing").textContent = "Not started"; tell(new Told(`this browser cannot run the page: ${error.message ?? error}`)); }), 0));
