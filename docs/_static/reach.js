// What scrolls within the page can be reached, and so be scrolled, by keyboard; what fits is no stop on the way.
"use strict";

(() => {
  const parts = document.querySelectorAll("pre, div.cell_output, div.picture");

  function reach() {
    for (const part of parts) {
      if (part.scrollWidth > part.clientWidth) {
        part.tabIndex = 0;
      } else {
        part.removeAttribute("tabindex");
      }
    }
  }

  reach();
  window.addEventListener("load", reach);
  window.addEventListener("resize", reach);
})();
