// Narrows the tables of the ledger by words, source, status and chapter. Without it the page shows all of them.
(() => {
  const form = document.getElementById("ledger-search");
  const tables = [...document.querySelectorAll("table.ledger")];
  const plain = (text) => text.toLowerCase().replace(/\s+/g, " ");
  const compact = (text) => text.replace(/ /g, "");
  const results = [];
  for (const table of tables) {
    for (const body of table.tBodies) {
      const entry = body.rows[0].textContent;
      let below = null; // rows with the same reason share the line below the last of them
      for (const row of [...body.rows].reverse()) {
        if (row.className === "why") below = row;
        if (!row.id) continue;
        const why = "w" in row.dataset ? below : null;
        const text = plain([entry, row.textContent, row.dataset.f, why ? why.textContent : ""].join(" "));
        results.push({
          row, why, body, table, text, formulas: compact(text),
          source: table.dataset.source, chapter: body.dataset.chapter, status: row.cells[0].classList[1],
        });
      }
    }
  }

  function narrow() {
    const asked = Object.fromEntries(new FormData(form));
    const words = plain(asked.q).split(" ").filter(Boolean);
    const shown = new Set();
    let count = 0;
    for (const result of results) {
      const fits = ["source", "status", "chapter"].every((key) => !asked[key] || result[key] === asked[key])
        && (words.every((word) => result.text.includes(word)) || result.formulas.includes(compact(plain(asked.q))));
      result.row.hidden = !fits;
      if (fits) {
        count += 1;
        shown.add(result.body).add(result.table).add(result.why);
      }
    }
    for (const { why } of results) if (why) why.hidden = !shown.has(why);
    for (const table of tables) {
      table.parentElement.hidden = !shown.has(table);
      for (const body of table.tBodies) body.hidden = !shown.has(body);
    }
    form.querySelector("output").value = count === results.length
      ? `All ${count} results.` : `${count || "No"} ${count === 1 ? "result" : "results"} of ${results.length}.`;
  }

  let waiting;
  form.addEventListener("input", () => { clearTimeout(waiting); waiting = setTimeout(narrow, 150); });
  form.addEventListener("reset", () => setTimeout(narrow));
  form.addEventListener("submit", (event) => { event.preventDefault(); narrow(); });
  for (const [key, value] of new URLSearchParams(location.search)) {
    if (form.elements[key]) form.elements[key].value = value;
  }
  form.hidden = false;
  if (location.search) {
    narrow();
    if (!location.hash) form.scrollIntoView();
  } else {
    form.querySelector("output").value = `All ${results.length} results.`;
  }
})();
