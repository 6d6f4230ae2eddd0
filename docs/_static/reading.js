// How a page is read. Who follows a link to a place within something folded finds it open, and what scrolls within the
// page is reached by keyboard. A chapter shows its core or all, with its code or without, which this browser keeps; and
// it prints the one or the other.
"use strict";

(() => {
  const root = document.documentElement;

  function unfold() {
    let place = null;
    try {
      place = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    } catch {
      return; // an address that is no text
    }
    const folded = [];
    for (let part = place; part; part = part.parentElement) {
      const own = part.matches("section.further") ? part.querySelector("details.further") : part;
      if (own.tagName === "DETAILS" && !own.open) folded.push(own);
    }
    for (const part of folded) part.open = true;
    if (folded.length) place.scrollIntoView();
  }

  // What fits is no stop on the way.
  function reach() {
    for (const part of document.querySelectorAll("pre, div.cell_output, div.picture")) {
      if (part.scrollWidth > part.clientWidth) part.tabIndex = 0;
      else part.removeAttribute("tabindex");
    }
  }

  // What is chosen is in the element of the page, where its template puts what the browser keeps.
  function choose(name, value) {
    root.dataset[name] = value;
    for (const button of document.querySelectorAll(`.switches [name="${name}"]`)) button.ariaPressed = String(button.value === value);
    if (name === "show") for (const part of document.querySelectorAll("details.further")) part.open = value === "all";
  }

  function keep(name, value) {
    choose(name, value);
    try {
      localStorage.setItem(`loopbook-${name}`, value);
    } catch {
      // a browser that keeps nothing forgets it with the page
    }
  }

  // Figures that nobody has come near yet are fetched first, and the fonts of print.css, which no screen needs.
  function fetchFigures() {
    const figures = [...document.querySelectorAll("article img")];
    for (const figure of figures) figure.loading = "eager";
    return figures;
  }

  async function print(what) {
    document.body.dataset.print = what;
    const fonts = ["", "italic ", "bold "].map((style) => document.fonts.load(`${style}10pt "STIX Two Text"`));
    await Promise.allSettled([...fonts, ...fetchFigures().map((figure) => figure.decode())]);
    window.print();
  }

  const switches = document.querySelector(".switches");
  switches?.addEventListener("click", ({ target }) => {
    if (target.name) keep(target.name, target.value);
    else if (target.dataset.print) print(target.dataset.print);
  });
  switches?.classList.add("work");
  if (switches) for (const [name, value] of [["show", "core"], ["code", "shown"]]) choose(name, root.dataset[name] ?? value);
  unfold();
  reach();
  window.addEventListener("hashchange", unfold);
  for (const change of ["load", "resize"]) window.addEventListener(change, reach);
  window.addEventListener("beforeprint", fetchFigures);
  window.addEventListener("afterprint", () => delete document.body.dataset.print);
})();
