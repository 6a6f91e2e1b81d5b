// The scans that were given, and what is chosen of them.

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
  if (terms.disabled) terms.value = "";
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
