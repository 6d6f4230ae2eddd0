// Who follows a link to a place within something folded finds it open.
"use strict";

(() => {
  function open() {
    let place = null;
    try {
      place = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    } catch {
      return; // an address that is no text
    }
    if (!place) return;
    const folded = [];
    for (let part = place; part; part = part.parentElement) if (part.tagName === "DETAILS" && !part.open) folded.push(part);
    for (const part of folded) part.open = true;
    if (folded.length) place.scrollIntoView();
  }

  open();
  window.addEventListener("hashchange", open);
})();
