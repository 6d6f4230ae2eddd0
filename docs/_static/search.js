// The search: as you type, in a dialog that Ctrl-K or / opens, and in the page search.html.
//
// The index is a script, _static/search/index.js, that the first search loads; a page opened from a disk may load that too.
// search_index.py writes it and says what is in it. The texts of the sections are in scripts beside it, one for each page.
"use strict";

(() => {
  const ROOT = document.documentElement.dataset.content_root || "";
  const AT_ONCE = 12; // results
  const AROUND = 70; // letters before the first word that is found, in an excerpt
  const LENGTH = 220; // of an excerpt
  const ALPHABET = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  const VALUE = Object.fromEntries([...ALPHABET].map((letter, value) => [letter, value]));
  const KINDS = ["example", "equation", "figure", "table", "section", "exercise"];
  const GREEK = { α: "alpha", β: "beta", γ: "gamma", δ: "delta", Δ: "delta", ε: "epsilon", ζ: "zeta", η: "eta", θ: "theta",
    κ: "kappa", λ: "lambda", μ: "mu", π: "pi", ρ: "rho", σ: "sigma", τ: "tau", φ: "phi", ω: "omega", Ω: "omega" };
  const FORM = 0.9; // what another form of a word counts, as tuning for tune, to the word itself
  const PREFIX = 0.4; // what its beginning counts
  const SIMILAR = 0.3; // what a word with another letter counts
  const TITLED = 3; // what a title of just these words adds to a section, in parts of what it counts otherwise
  const KINDS_OF_PAGES = { chapters: 1, solutions: 0.45, reference: 0.2 }; // what their sections count
  const OTHER_PAGE = 0.5;
  const shared = (window.loopbookSearch ||= { texts: {} });

  // What the index is made of.

  const loading = new Map();

  function load(name) {
    if (!loading.has(name)) {
      loading.set(name, new Promise((resolve, reject) => {
        const script = document.createElement("script");
        script.src = `${ROOT}_static/search/${name}.js`;
        script.onload = resolve;
        script.onerror = () => (loading.delete(name), reject(new Error(`${script.src} cannot be loaded`)));
        document.head.append(script);
      }));
    }
    return loading.get(name);
  }

  let book = null;

  async function opened() {
    await load("index");
    if (!book) {
      const { words, entries, common, ...rest } = shared.index;
      book = { ...rest, words: words.split(" "), entries: entries.split(" "), common: new Set(common.split(" ")) };
    }
    return book;
  }

  // The sections that have a word, and with what weight.
  function entry(number, sections = new Map(), share = 1) {
    const text = book.entries[number];
    const rarity = Math.log(1 + book.sections.length / (text.length / 3 + 1));
    for (let at = 0, section = 0; at < text.length; ) {
      for (let shift = 1; ; shift *= 32) {
        const value = VALUE[text[at++]];
        section += (value % 32) * shift;
        if (value < 32) break;
      }
      const weight = share * rarity * VALUE[text[at++]];
      if (weight > (sections.get(section) || 0)) sections.set(section, weight);
    }
    return sections;
  }

  // As in search_index.py.
  function words(text) {
    const plain = [...text].map((letter) => (GREEK[letter] ? ` ${GREEK[letter]} ` : letter)).join("");
    const cut = plain.replace(/(?<=\d)-(?=\d)/g, ".").normalize("NFKD").replace(/[^\x00-\x7f]/g, "").toLowerCase().match(/\d+(?:\.\d+)+[a-z]?|[a-z0-9]+/g);
    return (cut || []).map((word) => (/^..+[^sui0-9]s$/.test(word) && word.length > 3 ? word.slice(0, -1) : word));
  }

  // What tune, tuned and tuning have in common, and control and controllers.
  function stem(word) {
    const short = word.replace(/(?:ation|ion|ing|ed|er|es|e|s)$/, "");
    return short.length > 2 && /[aeiouy]/.test(short) ? short.replace(/([^aeiou])\1$/, "$1") : word;
  }

  function firstFrom(word) {
    let [low, high] = [0, book.words.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (book.words[middle] < word) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  // The sections with a word or a form of it, with words that begin with it, or else with words that are nearly it.
  function sectionsWith(word, isLast) {
    const sections = new Map();
    const least = isLast ? 1 : 3; // of letters, for a beginning
    const root = stem(word);
    for (let k = firstFrom(root); k < book.words.length && book.words[k].startsWith(root); k++) {
      const other = book.words[k];
      if (other === word) entry(k, sections);
      else if (stem(other) === root) entry(k, sections, FORM);
      else if (other.startsWith(word) && word.length >= least) entry(k, sections, PREFIX);
    }
    if (!sections.size && word.length > 3 && !/\d/.test(word)) {
      const limit = word.length > 7 ? 2 : 1;
      book.words.forEach((other, k) => {
        if (Math.abs(other.length - word.length) <= limit && distance(word, other, limit) <= limit) entry(k, sections, SIMILAR);
      });
    }
    return sections;
  }

  // How many letters are to be changed, put in or taken out; stops where it is more than a limit.
  function distance(one, other, limit) {
    let row = Array.from({ length: other.length + 1 }, (_, k) => k);
    for (let i = 1; i <= one.length; i++) {
      const next = [i];
      for (let j = 1; j <= other.length; j++) {
        next[j] = Math.min(row[j] + 1, next[j - 1] + 1, row[j - 1] + (one[i - 1] === other[j - 1] ? 0 : 1));
      }
      row = next;
      if (Math.min(...row) > limit) return limit + 1;
    }
    return row[other.length];
  }

  // What is asked, without the words of a question.
  function core(text) {
    const all = words(text);
    const asked = all.filter((word) => !book.common.has(word));
    return asked.length ? asked : all;
  }

  // What is asked, and what the book may call it: lists of words; and what there is to know before.
  function ways(asked) {
    const found = [asked];
    const notes = new Set();
    const text = ` ${asked.join(" ")} `;
    for (const [typed, meant, note] of book.aliases) {
      if (!text.includes(` ${typed} `)) continue;
      if (note) notes.add(note);
      for (const said of meant) found.push(core(text.replace(` ${typed} `, ` ${said} `)));
    }
    return { found: found.slice(0, 8), note: [...notes].join(" ") };
  }

  // The places of the book that a number names, as "10.15", "Eq. (10.15)" or "table 12.3".
  function numbered(text) {
    const asked = text.trim().replace(/(?<=\d)-(?=\d)/g, ".").match(/^([a-z]*)\.?\s*\(?((?:[a-z]\.)?\d+(?:\.\d+)*[a-z]?)\)?$/i);
    if (!asked) return [];
    const [, kind, number] = asked;
    const kinds = kind ? KINDS.filter((one) => one.startsWith(kind.toLowerCase().replace(/^(eqn|eqs)$/, "eq"))) : KINDS;
    if (!kind && !number.includes(".")) return [];
    const end = number.toLowerCase().replaceAll(".", "-");
    return kinds.flatMap((one) => (book.places[`${one}-${end}`] || []).map((section) => ({
      section, place: `${one}-${end}`, label: `${one[0].toUpperCase()}${one.slice(1)} ${number.toUpperCase()}`,
    })));
  }

  function ranked(text) {
    const places = numbered(text);
    if (places.length) return { results: places, asked: words(text), note: "", complete: true };
    const asked = core(text);
    const { found, note } = ways(asked);
    const isCode = /[a-z][._]|\(/i.test(text.trim()); // first_order: a function of the library
    const total = new Map();
    let complete = false;
    for (const [rank, way] of found.entries()) {
      const places = together(way, way === asked).map(({ section, weight, share }) => {
        const [kind] = book.pages[book.sections[section][0]][0].split("/");
        const worth = isCode && kind === "reference" ? 1.5 : (KINDS_OF_PAGES[kind] ?? OTHER_PAGE);
        return { section, weight: weight * worth, share };
      });
      const most = Math.max(...places.map(({ weight }) => weight)); // each way has a best place,
      const share = Math.max(...places.map(({ share }) => share)) ** 2; // which counts less where a word is missing
      complete ||= share === 1;
      for (const { section, weight } of places) {
        total.set(section, Math.max(total.get(section) || 0, (rank ? 1 : 0.98) * share * (weight / most)));
      }
    }
    const order = [...total].sort((a, b) => b[1] - a[1] || a[0] - b[0]);
    return { results: order.map(([section]) => ({ section })), asked: found.flat(), note, complete };
  }

  // The sections that have words: all of them if there are such, and they count more where their title has them.
  function together(way, isTyped) {
    const found = new Map();
    way.forEach((word, k) => {
      for (const [section, weight] of sectionsWith(word, isTyped && k === way.length - 1)) {
        const { sum, count } = found.get(section) || { sum: 0, count: 0 };
        found.set(section, { sum: sum + weight, count: count + 1 });
      }
    });
    const roots = new Set(way.map(stem));
    return [...found].map(([section, { sum, count }]) => {
      const share = count / way.length;
      const title = core(book.sections[section][2].replace(/^.* · /, ""));
      const named = title.filter((word) => roots.has(stem(word))).length;
      const titled = 1 + (TITLED * named ** 2) / (title.length * way.length);
      return { section, share, weight: sum * share ** 3 * titled };
    });
  }

  // What is shown.

  function element(name, properties = {}, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  }

  // A text with the words that were asked for marked.
  function marked(text, asked) {
    const pieces = text.split(/([\p{L}\p{N}]+)/u);
    return pieces.map((piece, k) => (k % 2 && isAsked(piece, asked) ? element("mark", {}, piece) : piece));
  }

  function excerpt(text, asked) {
    let best = [0, -1];
    for (const found of text.matchAll(/[\p{L}\p{N}]+/gu)) {
      if (!isAsked(found[0], asked)) continue;
      const near = text.slice(found.index, found.index + LENGTH - AROUND);
      const kinds = new Set([...near.matchAll(/[\p{L}\p{N}]+/gu)].flatMap(([word]) => (isAsked(word, asked) ? words(word) : [])));
      if (kinds.size > best[1]) best = [found.index, kinds.size];
      if (kinds.size >= asked.length) break;
    }
    const from = best[0] > AROUND ? text.indexOf(" ", best[0] - AROUND) + 1 : 0;
    const to = text.length > from + LENGTH ? text.lastIndexOf(" ", from + LENGTH) : text.length;
    return [from ? "… " : "", ...marked(text.slice(from, to), asked), to < text.length ? " …" : ""];
  }

  function isAsked(piece, asked) {
    return words(piece).some((word) => asked.some((one) => (one.length > 2 ? word.startsWith(stem(one)) : word === one)));
  }

  function result({ section, place, label }, asked) {
    const [page, id, title, above] = book.sections[section];
    const [name, pageTitle] = book.pages[page];
    const kind = name.startsWith("solutions/") || title === pageTitle ? "" : pageTitle;
    const text = element("span", { className: "search-excerpt" });
    const where = [kind || (name.startsWith("chapters/") ? "Chapter" : ""), above].filter(Boolean).join(" › ");
    const link = element("a", { href: `${ROOT}${name}.html#${place || id}` },
      element("b", {}, ...(label && !title.startsWith(label) ? [element("mark", {}, label), ` · ${title}`] : marked(title, asked))),
      element("small", {}, where), text);
    const at = book.sections.slice(0, section).filter(([other]) => other === page).length;
    load(page).then(() => text.replaceChildren(...excerpt(shared.texts[page][at], asked)), () => {});
    return element("li", {}, link);
  }

  class Search {
    constructor(place, input) {
      this.input = input;
      this.said = element("p", { className: "search-said" });
      this.said.setAttribute("role", "status");
      this.list = element("ol", { className: "search-found" });
      this.more = element("button", { type: "button", className: "search-more", hidden: true }, "More");
      place.append(this.said, this.list, this.more);
      this.shown = AT_ONCE;
      input.addEventListener("input", () => ((this.shown = AT_ONCE), this.show()));
      this.more.addEventListener("click", () => {
        const last = this.list.lastElementChild;
        this.shown += AT_ONCE;
        this.show().then(() => last?.isConnected || this.list.children[this.shown - AT_ONCE]?.querySelector("a").focus());
      });
      place.addEventListener("keydown", (event) => this.walk(event));
    }

    async show() {
      const text = this.input.value;
      if (!words(text).length) {
        this.list.replaceChildren();
        this.said.textContent = "";
        this.more.hidden = true;
        return;
      }
      try {
        await opened();
      } catch (problem) {
        this.said.textContent = `The search is not there: ${problem.message}.`;
        return;
      }
      if (text !== this.input.value) return; // more has been typed meanwhile
      const { results, asked, note, complete } = ranked(text);
      this.list.replaceChildren(...results.slice(0, this.shown).map((one) => result(one, asked)));
      this.more.hidden = results.length <= this.shown;
      const count = `${results.length} ${results.length === 1 ? "place" : "places"}`;
      const said = !results.length ? "Nothing is found. Another word?"
        : complete || note ? count : `No place has all the words; ${count} with some of them.`;
      this.said.replaceChildren(...(note ? [element("strong", {}, note), " "] : []), said);
    }

    // Up and down among the results; Enter in the field follows the first.
    walk(event) {
      const stops = [this.input, ...this.list.querySelectorAll("a")];
      const at = stops.indexOf(document.activeElement);
      if (event.key === "Escape" && dialog?.open) {
        event.preventDefault(); // which would only empty the field
        dialog.close();
        return;
      }
      const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (step && at >= 0 && stops[at + step]) {
        event.preventDefault();
        stops[at + step].focus();
      } else if (event.key === "Enter" && at === 0) {
        event.preventDefault();
        stops[1]?.click();
      }
    }
  }

  // The dialog, made when it is asked for first.

  function field() {
    const input = element("input", { type: "search", autocomplete: "off", spellcheck: false });
    input.setAttribute("aria-label", "Search the book");
    input.placeholder = "wind-up, half rule, Smith predictor, Eq. 10.15";
    return input;
  }

  let dialog = null;
  let search = null;

  function ask(text = "") {
    if (!dialog) {
      const input = field();
      const close = element("button", { type: "button", className: "search-close" }, "Close");
      dialog = element("dialog", { className: "search-dialog" }, element("div", { className: "search-head" }, input, close));
      dialog.setAttribute("aria-label", "Search");
      document.body.append(dialog);
      search = new Search(dialog, input);
      close.addEventListener("click", () => dialog.close());
      dialog.addEventListener("click", (event) => {
        if (event.target === dialog || event.target.closest("ol a")) dialog.close();
      });
    }
    if (!dialog.open) dialog.showModal();
    if (text) search.input.value = text;
    search.input.focus();
    search.input.select();
    if (text) search.input.setSelectionRange(text.length, text.length);
    search.show();
    opened().catch(() => {});
  }

  const here = document.querySelector(".search-page");
  if (here) {
    const input = field();
    here.append(input);
    const search = new Search(here, input);
    input.value = new URLSearchParams(location.search).get("q") || "";
    input.focus();
    search.show();
  }

  for (const form of document.querySelectorAll("form.sidebar-search-container")) {
    const input = form.querySelector("input[name=q]");
    const away = () => {
      ask(input.value);
      input.value = "";
    };
    input.placeholder = "Search (Ctrl-K)";
    input.addEventListener("click", away);
    input.addEventListener("input", away);
    form.addEventListener("submit", (event) => (event.preventDefault(), away()));
  }

  document.addEventListener("keydown", (event) => {
    const typing = event.target.closest?.("input, textarea, select, [contenteditable]");
    const wanted = (event.key === "k" && (event.ctrlKey || event.metaKey)) || (event.key === "/" && !typing);
    if (!wanted || event.altKey) return;
    event.preventDefault();
    ask();
  });
})();
