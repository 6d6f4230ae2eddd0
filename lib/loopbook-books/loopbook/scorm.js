// A page of exercises in a learning management system, by SCORM 1.2: it tells how many are right, and nothing else.
//
// The system keeps the numbers of the exercises that are right (cmi.suspend_data), so that another browser knows them.
"use strict";

(() => {
  const KEY = "loopbook"; // of what exercises.js remembers
  const numbers = window.loopbookExercises.chapters.flatMap(({ exercises }) => exercises.map(({ number }) => number));
  const api = find(window) ?? (window.opener && find(window.opener));
  let right = new Set();

  function find(start) {
    try {
      for (let at = start, count = 0; count < 10; at = at.parent, count++) if (at.API) return at.API;
    } catch {
      // a frame around this one is of another place
    }
    return null;
  }

  function table(text) {
    try {
      return JSON.parse(text) ?? {};
    } catch {
      return {};
    }
  }

  function isRight(number, answered) {
    return Object.entries(answered).some(([key, value]) => value === true && key.split(" ")[0] === number);
  }

  function report() {
    let answered = {};
    try {
      answered = table(localStorage.getItem(KEY)).answered ?? {};
    } catch {
      // a browser that keeps nothing
    }
    for (const number of numbers) if (isRight(number, answered)) right.add(number);
    const said = {
      "cmi.core.score.min": 0, "cmi.core.score.max": 100,
      "cmi.core.score.raw": Math.round((100 * right.size) / numbers.length),
      "cmi.core.lesson_status": right.size === numbers.length ? "completed" : "incomplete",
      "cmi.suspend_data": JSON.stringify([...right]), "cmi.core.exit": "suspend",
    };
    for (const [name, value] of Object.entries(said)) api.LMSSetValue(name, String(value));
    const isKept = String(api.LMSCommit("")) === "true";
    document.querySelector(".lms").textContent = isKept
      ? `${right.size} of ${numbers.length} are right, which your course knows.`
      : "Your course does not take the progress: it stays in this browser.";
  }

  const isThere = api && String(api.LMSInitialize("")) === "true";
  if (isThere) {
    const before = table(api.LMSGetValue("cmi.suspend_data"));
    right = new Set(Array.isArray(before) ? before.filter((number) => numbers.includes(number)) : []);
    try {
      const all = table(localStorage.getItem(KEY));
      all.answered = { ...all.answered, ...Object.fromEntries([...right].map((number) => [number, true])) };
      localStorage.setItem(KEY, JSON.stringify(all));
    } catch {
      // a browser that keeps nothing
    }
  }
  document.addEventListener("DOMContentLoaded", () => {
    if (isThere) report();
    else document.querySelector(".lms").textContent = "No course listens here: the progress stays in this browser.";
  });
  document.addEventListener("loopbook-progress", () => isThere && report());
  window.addEventListener("pagehide", () => isThere && api.LMSFinish(""));
})();
