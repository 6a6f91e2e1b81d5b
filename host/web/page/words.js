// The command line that does the same: options are one object, which the module reads and of which the words are made.

/** @param {string} word */
function quoted(word) {
  if (/^[\w.,:=+@%\/-]+$/.test(word)) return word;
  // Double quotes mean the same to cmd, PowerShell and sh if nothing in them means anything.
  if (!/["$`\\!%]/.test(word)) return `"${word}"`;
  return `'${word.replaceAll("'", "'\\''")}'`;
}

/**
 * Options as words.
 * @param {Record<string, any>} options
 * @returns {string[]}
 */
function words(options) {
  /** @type {string[]} */
  const list = [];
  for (const [name, value] of Object.entries(options)) {
    for (const one of Array.isArray(value) ? value : [value]) {
      if (one === false || one === null) continue;
      const text = String(one);
      if (one === true) list.push(`--${name}`);
      else if (text.startsWith("-")) list.push(`--${name}=${text}`);
      else list.push(`--${name}`, text);
    }
  }
  return list;
}

/**
 * @param {string} command such as `fit`
 * @param {{files: string[], read: object, search: object}} of
 * @param {string[]} more
 */
function commandLine(command, of, more = []) {
  const files = of.files.map((name) => (name.startsWith("-") ? `./${name}` : name));
  return ["brdfit", command, ...files, ...words(of.read), ...words(of.search), ...more].map(quoted).join(" ");
}
