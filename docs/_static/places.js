// Who follows a link to a place within something folded finds it open; and the list at the side says where one is.
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

  // The sections of this page, in the list at the side: the one that is being read is marked.
  const links = new Map(
    [...document.querySelectorAll(".here a")].map((link) => [decodeURIComponent(link.hash.slice(1)), link]),
  );
  const sections = [...links.keys()].map((id) => document.getElementById(id)).filter(Boolean);
  if (!sections.length) return;
  let marked = null;

  function mark() {
    const end = scrollY + innerHeight > document.documentElement.scrollHeight - 4; // what is last may be short
    const line = end ? innerHeight : innerHeight / 3;
    const read = sections.findLast((section) => section.getBoundingClientRect().top < line);
    const link = read && links.get(read.id);
    if (link === marked) return;
    marked?.removeAttribute("aria-current");
    marked = link;
    if (!link) return;
    link.setAttribute("aria-current", "location");
    const list = link.closest(".sidebar-scroll");
    const [box, frame] = [link.getBoundingClientRect(), list.getBoundingClientRect()];
    if (box.top < frame.top || box.bottom > frame.bottom) list.scrollTop += box.top - frame.top - frame.height / 3;
  }

  let waiting = false;
  const soon = () => {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => ((waiting = false), mark()));
  };
  document.addEventListener("scroll", soon, { passive: true });
  window.addEventListener("resize", soon);
  mark();
})();
