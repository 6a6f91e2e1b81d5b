// Every option of the page: its name is the one of the command line.

/**
 * @typedef {{name: string, label: string, kind: "choice" | "number" | "list" | "numbers" | "flag" | "text", choices?: [string, string][], min?: number, max?: number, step?: string, title?: string, wide?: boolean}} Setting
 */

/** @param {any} about @returns {Setting[]} */
function readSettings(about) {
  return [
    { name: "input-format", label: "Format", kind: "choice", wide: true, choices: [["", "known by content"], ...about.formats.map((/** @type {any} */ one) => [one.name, one.title])] },
    { name: "quantity", label: "Values are", kind: "choice", choices: [["", "what the file says, or BRDF"], ["brdf", "BRDF"], ["ln-brdf", "ln BRDF"], ["log10-brdf", "log10 BRDF"], ["brdf-cos", "BRDF times cos theta_s"], ["brf", "reflectance factor"], ["brf-cos", "reflectance factor times cos theta_s"]] },
    { name: "value-unit", label: "Counted in", kind: "choice", choices: [["", "as named, or plain"], ["plain", "plain"], ["percent", "percent"]] },
    { name: "angles", label: "Angles in", kind: "choice", choices: [["", "the format's"], ["deg", "degrees"], ["rad", "radians"]] },
    { name: "forward", label: "Specular peak at", kind: "choice", choices: [["", "as the scan says"], ["positive", "+theta_i"], ["negative", "−theta_i"]] },
    { name: "polarisation", label: "s and p", kind: "choice", choices: [["", "apart"], ["mean", "their mean"]] },
    { name: "wavelength-unit", label: "Wavelengths in", kind: "choice", choices: [["", "as named, or by size"], ["nm", "nm"], ["um", "µm"], ["m", "m"], ["angstrom", "ångström"], ["per-cm", "1/cm"]] },
    { name: "columns", label: "Columns, such as theta_s=2,brdf=3", kind: "list", wide: true },
    { name: "split", label: "A scan for each content of", kind: "list" },
    { name: "ignore", label: "Columns to leave aside", kind: "list" },
    { name: "theta-i", label: "Angles of incidence, degrees", kind: "numbers" },
    { name: "coverage", label: "Coverage factor", kind: "number", min: 0, step: "any" },
    { name: "weights", label: "Weights", kind: "choice", choices: [["", "of the file, if any"], ["equal", "all equal"]] },
    { name: "sigma-floor", label: "Relative deviation added", kind: "number", min: 0, step: "any" },
    { name: "one-scan", label: "all files are one scan", kind: "flag" },
    { name: "repeats", label: "rows may repeat", kind: "flag" },
    { name: "drop-invalid", label: "leave out invalid rows", kind: "flag" },
  ];
}

/** @type {Setting[]} */
const MASKS = [
  { name: "mask-retro", label: "Near retro, within °", kind: "number", min: 0, max: 180, step: "any" },
  { name: "max-angle", label: "Angles beyond, °", kind: "number", min: 0, max: 180, step: "any" },
  { name: "max-value", label: "Values from, as in file", kind: "number", step: "any" },
  { name: "thin", label: "One row in", kind: "number", min: 1, step: "1" },
];

/** @param {any} about @returns {Setting[]} */
function searchSettings(about) {
  return [
    { name: "model", label: "Model", kind: "choice", wide: true, choices: [["", `${about.models[0].name}: ${about.models[0].what}`], ...about.models.slice(1).map((/** @type {any} */ one) => [one.name, `${one.name}: ${one.what}`]), ["auto", "auto: the one of least BIC"]] },
    { name: "terms", label: "Terms", kind: "choice", wide: true, choices: [["", "all"], ["auto", "auto: the fewest that the scan supports"], ["diffuse", "diffuse"], ["diffuse,surface", "diffuse, surface"], ["diffuse,surface,absorbing", "diffuse, surface, absorbing"], ["diffuse,surface,volume", "diffuse, surface, volume"], ["surface", "surface"], ["surface,absorbing", "surface, absorbing"], ["surface,volume,absorbing", "surface, volume, absorbing"]] },
    { name: "method", label: "Search", kind: "choice", choices: [["", "default"], ["paper", "paper: full fits from uniform starts"]] },
    { name: "starts", label: "Starts", kind: "number", min: 1, max: 1000000, step: "1" },
    { name: "seed", label: "Seed", kind: "number", min: 0, max: Number.MAX_SAFE_INTEGER, step: "1" },
    { name: "precision", label: "Numbers", kind: "choice", choices: [["", "double"], ["f32", "single"]] },
    { name: "robust", label: "leave out samples far from the fit", kind: "flag" },
  ];
}

/**
 * Fields for settings; `changed` is called when one of them changes.
 * @param {Setting[]} settings
 * @param {Element} into
 * @param {() => void} changed
 */
function fields(settings, into, changed) {
  into.replaceChildren(...settings.map((one) => {
    const id = `option-${one.name}`;
    const attributes = { id, onchange: changed, title: `--${one.name}` };
    if (one.kind === "choice") {
      const options = (one.choices ?? []).map(([value, text]) => h("option", { value }, text));
      return h("label", { class: one.wide ? "wide" : null, for: id }, one.label, h("select", attributes, ...options));
    }
    if (one.kind === "flag") return h("label", { class: "flag", for: id }, h("input", { ...attributes, type: "checkbox" }), one.label);
    const type = one.kind === "number" ? "number" : "text";
    return h("label", { class: one.wide ? "wide" : null, for: id }, one.label, h("input", { ...attributes, type, min: one.min, max: one.max, step: one.step, spellcheck: "false", autocomplete: "off" }));
  }));
}

/**
 * The settings that are not as usual.
 * @param {Setting[]} settings
 * @returns {Record<string, any>}
 */
function chosen(settings) {
  /** @type {Record<string, any>} */
  const options = {};
  for (const one of settings) {
    const field = $(`option-${one.name}`);
    if (one.kind === "flag") { if (field.checked) options[one.name] = true; continue; }
    const text = field.value.trim();
    if (text === "") {
      if (field.validity?.badInput) throw new Told(`${one.label}: this is not a number`);
      continue;
    }
    const list = () => text.split(",").map((/** @type {string} */ part) => part.trim()).filter((/** @type {string} */ part) => part !== "");
    if (one.kind === "number") {
      const value = Number(text);
      if (!field.checkValidity()) throw new Told(`${one.label}: ${field.validationMessage}`);
      options[one.name] = value;
    } else if (one.kind === "numbers") {
      options[one.name] = list().map((/** @type {string} */ part) => {
        if (!Number.isFinite(Number(part))) throw new Told(`${one.label}: '${part}' is not a number`);
        return Number(part);
      });
    } else if (one.kind === "list") options[one.name] = list();
    else options[one.name] = text;
  }
  return options;
}
