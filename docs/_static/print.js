// Prints a chapter: its core, or all of it. Figures that nobody has come near yet are fetched first.
"use strict";

(() => {
  const choice = document.querySelector(".print-choice");
  const paper = '10pt "STIX Two Text"'; // the fonts of print.css, which no screen needs

  function fetchFigures() {
    const figures = [...document.querySelectorAll("article img")];
    for (const figure of figures) figure.loading = "eager";
    return figures;
  }

  async function print(what) {
    document.body.dataset.print = what;
    const fonts = ["", "italic ", "bold "].map((style) => document.fonts.load(style + paper));
    await Promise.allSettled([...fonts, ...fetchFigures().map((figure) => figure.decode())]);
    window.print();
  }

  choice.addEventListener("click", (event) => {
    if (event.target.dataset.print) print(event.target.dataset.print);
  });
  window.addEventListener("beforeprint", fetchFigures);
  window.addEventListener("afterprint", () => delete document.body.dataset.print);
  choice.classList.add("works");
})();
