"use strict";
// Tables that sort, what marks tell when they are pointed at, commands to copy, the section that is in sight.

// Numbers before words, both rising; what is not there comes last
function sort_by(header) {
  const table = header.closest("table"), column = [...header.parentElement.children].indexOf(header);
  const falls = header.getAttribute("aria-sort") === "ascending";
  for (const other of header.parentElement.children) other.removeAttribute("aria-sort");
  header.setAttribute("aria-sort", falls ? "descending" : "ascending");
  const key = row => {
    const cell = row.children[column], text = cell.dataset.value ?? cell.textContent;
    return {text, number: text.trim() === "" || text === "nan" ? NaN : Number(text)};
  };
  const rows = [...table.tBodies[0].rows].map(row => ({row, ...key(row)}));
  const words = rows.some(({text, number}) => Number.isNaN(number) && text.trim() !== "" && text !== "nan");
  const last = ({text, number}) => words ? text.trim() === "" : Number.isNaN(number);
  rows.sort((a, b) => last(a) - last(b) ||
    (falls ? -1 : 1) * (words ? a.text.localeCompare(b.text, "en", {numeric: true}) : a.number - b.number));
  table.tBodies[0].append(...rows.map(({row}) => row));
}

// What a mark tells: the title of the element under the pointer, or of the nearest dot
function add_tips() {
  const tip = document.createElement("div");
  tip.id = "tip";
  tip.hidden = true;
  document.body.append(tip);
  let marked = null;
  const hide = () => {
    tip.hidden = true;
    if (marked) marked.classList.remove("near");
    marked = null;
  };
  for (const chart of document.querySelectorAll("svg.chart")) {
    for (const title of chart.querySelectorAll("title")) {
      title.parentElement.dataset.tip = title.textContent;
      title.parentElement.setAttribute("aria-label", title.textContent);
      title.remove();
    }
    const dots = [...chart.querySelectorAll("circle[data-tip]")].map(
      dot => [dot, Number(dot.getAttribute("cx")), Number(dot.getAttribute("cy"))]);
    const found = event => {
      const inside = new DOMPoint(event.clientX, event.clientY).matrixTransform(chart.getScreenCTM().inverse());
      let best = null, least = 15 ** 2;
      for (const [dot, x, y] of dots) {
        const far = (x - inside.x) ** 2 + (y - inside.y) ** 2;
        if (far < least) [best, least] = [dot, far];
      }
      return best || event.target.closest("[data-tip]");
    };
    chart.addEventListener("pointermove", event => {
      const mark = found(event);
      if (!mark) return hide();
      if (mark !== marked) {
        hide();
        marked = mark;
        if (mark.tagName === "circle") mark.classList.add("near");
        tip.textContent = mark.dataset.tip;
        tip.hidden = false;
      }
      const wide = document.documentElement.clientWidth;
      tip.style.left = `${Math.max(4, Math.min(event.clientX + 14, wide - tip.offsetWidth - 8))}px`;
      tip.style.top = `${event.pageY + 16}px`;
    });
    chart.addEventListener("pointerleave", hide);
    chart.addEventListener("click", event => choose(found(event)));
  }
}

// A row or a mark that stands for a shape shows it in the viewer of its folder
function choose(element) {
  const marked = element && element.closest("[data-shape]");
  if (marked) show_shape(`${marked.closest("article").id}-viewer`, Number(marked.dataset.shape));
}

addEventListener("DOMContentLoaded", () => {
  for (const header of document.querySelectorAll("table.sortable th"))
    header.querySelector("button").addEventListener("click", () => sort_by(header));
  for (const row of document.querySelectorAll("tr[data-shape]")) row.addEventListener("click", () => choose(row));
  for (const button of document.querySelectorAll(".copy"))
    button.addEventListener("click", async () => {
      const code = button.previousElementSibling;
      try {
        await navigator.clipboard.writeText(code.textContent);
        button.textContent = "Copied";
      } catch {
        getSelection().selectAllChildren(code);
      }
    });
  add_tips();
  const links = new Map([...document.querySelectorAll("nav a")].map(link => [link.hash.slice(1), link]));
  const look = new IntersectionObserver(entries => {
    for (const entry of entries)
      if (entry.isIntersecting) {
        links.forEach(link => link.classList.remove("here"));
        links.get(entry.target.id).classList.add("here");
      }
  }, {rootMargin: "-20% 0px -70% 0px"});
  for (const id of links.keys()) if (document.getElementById(id)) look.observe(document.getElementById(id));
});
