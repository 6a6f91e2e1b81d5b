// The fit of the current scan, and what is shown of it.

const FORMS = ["zemax", "zemax-abg", "fred", "glsl", "mitsuba", "mitsuba-native", "mitsuba-principled", "gltf", "materialx", "openpbr", "rgl", "c", "rust", "bird", "openmaterial"];
/** @type {Record<string, string>} */
const ENDINGS = { zemax: "bsdf", "zemax-abg": "dat", fred: "frs", glsl: "brdf", mitsuba: "py", "mitsuba-native": "py", "mitsuba-principled": "py", gltf: "gltf", materialx: "mtlx", openpbr: "mtlx", rgl: "bsdf", c: "h", rust: "rs", bird: "json", openmaterial: "xompt" };

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
