// Searches the results of all chapters by words, source, status and chapter. The rows come with the first use, as
// window.loopbookLedger (docs/extensions/ledger_page.py, `rows`): a few at a time are in the page. An old address of
// a result, ledger.html#ledger-..., leads on to the page that has it now.
(() => {
  const form = document.getElementById("ledger-search");
  const found = document.getElementById("ledger-found");
  const here = new URL(document.currentScript.src);
  const AT_FIRST = 60; // rows; more at a press, because each has some twenty elements
  const plain = (text) => text.toLowerCase().replace(/\s+/g, " ");
  const compact = (text) => text.replace(/ /g, "");
  const escaped = (text) => text.replace(/[&<>"]/g, (sign) => `&#${sign.charCodeAt(0)};`);
  const SIGNS = { "&nbsp;": " ", "&lt;": "<", "&gt;": ">", "&quot;": '"', "&#x27;": "'", "&amp;": "&" };
  const textOf = (html) => html.replace(/<t[dh][^>]*>/g, " ").replace(/<[^>]*>/g, "").replace(/&#?\w+;/g, (sign) => SIGNS[sign] ?? sign);

  let results; // of all chapters, a promise
  function loaded() {
    results ??= new Promise((done, failed) => {
      const script = document.createElement("script");
      script.src = new URL("ledger-rows.js", here);
      script.onload = () => done(prepared(window.loopbookLedger));
      script.onerror = () => failed(new Error("The results could not be fetched. They are on the pages below."));
      document.head.append(script);
    });
    return results;
  }

  function prepared({ entries }) {
    return entries.flatMap(([source, chapter, place, cell, name, title, rows, slips]) => {
      const entry = { source, chapter, place, cell, name, title, slips };
      return rows.map(([result, status, words, cells, why]) => {
        const text = plain([name, title, `chapter ${number(chapter)}`, textOf(cells), words, textOf(why)].join(" "));
        return { entry, result, status, cells, why, text, formulas: compact(text) };
      });
    });
  }

  const number = (chapter) => chapter.split("_")[0].replace(/^0/, "");

  function fits({ entry, status, text, formulas }, asked, words) {
    return (!asked.source || entry.source === asked.source)
      && (!asked.status || status === asked.status)
      && (!asked.chapter || entry.chapter === asked.chapter)
      && (words.every((word) => text.includes(word)) || formulas.includes(compact(plain(asked.q))));
  }

  // The rows as tables, one for each source, with a heading for each entry.
  function tables(rows) {
    const { sources, columns } = window.loopbookLedger;
    const head = columns.map((name) => `<th scope="col">${name}`).join("");
    const parts = [];
    rows.forEach(({ entry, result, cells, why }, k) => {
      const before = rows[k - 1]?.entry;
      const after = rows[k + 1];
      if (entry.source !== before?.source) {
        parts.push(`${before ? "</tbody></table></div>" : ""}<div class="ledger-frame" tabindex="0" role="region"
          aria-label="${escaped(sources[entry.source])}"><table class="ledger results">
          <caption>${escaped(sources[entry.source])}</caption><thead><tr>${head}</thead>`);
      }
      if (entry !== before) {
        parts.push(`<tbody><tr class="entry"><th scope="rowgroup" colspan="5">
          <a href="chapters/${entry.chapter}.html#${entry.cell}">${escaped(entry.name)}</a> · ${escaped(entry.title)}
          <small><a href="ledger/${entry.chapter}.html#${entry.place}">chapter ${number(entry.chapter)}</a></small>`);
      }
      parts.push(`<tr data-result="${escaped(`${entry.place}.${result}`)}"${why ? " class=noted" : ""}>${cells}`);
      if (why && !(after?.entry === entry && after.why === why)) parts.push(`<tr class="why"><td colspan="5">${why}`);
      if (after?.entry !== entry) {
        parts.push(...entry.slips.map((slip) => `<tr class="slip"><td colspan="5">${slip}`), "</tbody>");
      }
    });
    return parts.join("");
  }

  function show(rows, most) {
    found.className = "";
    found.innerHTML = tables(rows.slice(0, most));
    if (rows.length <= most) return;
    const more = document.createElement("button");
    more.type = "button";
    more.textContent = `Show ${Math.min(4 * AT_FIRST, rows.length - most)} more`;
    more.addEventListener("click", () => {
      const last = found.querySelectorAll("tr[data-result]").length;
      show(rows, most + 4 * AT_FIRST);
      const next = found.querySelectorAll("tr[data-result]")[last];
      next.tabIndex = -1; // where the reader goes on
      next.focus();
    });
    found.append(more);
  }

  async function search() {
    const asked = Object.fromEntries(new FormData(form));
    const output = form.querySelector("output");
    const words = plain(asked.q).split(" ").filter(Boolean);
    const idle = !words.length && !asked.source && !asked.status && !asked.chapter;
    if (idle) {
      found.className = "";
      found.replaceChildren();
      output.value = "";
      return;
    }
    try {
      const all = await loaded();
      const rows = all.filter((row) => fits(row, asked, words));
      output.value = `${rows.length || "No"} ${rows.length === 1 ? "result" : "results"} of ${all.length}.`;
      show(rows, AT_FIRST);
    } catch (problem) {
      output.value = problem.message;
    }
  }

  function decoded(text) {
    try {
      return decodeURIComponent(text);
    } catch {
      return text; // no place is named so
    }
  }

  async function moved(place) {
    const row = (await loaded()).find(({ entry }) => entry.place === place.split(".")[0]);
    if (row) location.replace(`ledger/${row.entry.chapter}.html#${place}`);
  }

  let waiting;
  form.addEventListener("focusin", () => loaded().catch(() => {}), { once: true });
  form.addEventListener("input", () => { clearTimeout(waiting); waiting = setTimeout(search, 150); });
  form.addEventListener("reset", () => setTimeout(search));
  form.addEventListener("submit", (event) => { event.preventDefault(); search(); });
  for (const [key, value] of new URLSearchParams(location.search)) {
    if (form.elements[key]) form.elements[key].value = value;
  }
  if (location.search) search();
  if (location.hash.startsWith("#ledger-")) moved(decoded(location.hash.slice(1)));
})();
