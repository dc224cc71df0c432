// Tables of class "sheet" sort by the column whose heading is clicked; long ones have a box that filters rows.

const LONG = 8;
const collator = new Intl.Collator("en", { numeric: true, sensitivity: "base" });

/** Compare texts, as numbers where both begin with one; empty ones are last. */
function compare(a, b) {
  if (!a || !b) return Number(!a) - Number(!b);
  const between = parseFloat(a) - parseFloat(b);
  return Number.isNaN(between) || between === 0 ? collator.compare(a, b) : between;
}

function sort(table, heading, column) {
  const descending = heading.getAttribute("aria-sort") === "ascending";
  for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
  heading.setAttribute("aria-sort", descending ? "descending" : "ascending");
  const body = table.tBodies[0];
  const rows = [...body.rows].map((row) => [row, row.cells[column]?.textContent.trim() ?? ""]);
  rows.sort((a, b) => (descending ? compare(b[1], a[1]) : compare(a[1], b[1])));
  body.append(...rows.map(([row]) => row));
}

function makeSortable(table) {
  [...table.tHead.rows[0].cells].forEach((heading, column) => {
    if (!heading.textContent.trim()) return;
    const button = document.createElement("button");
    button.type = "button";
    button.className = "sort";
    button.append(...heading.childNodes);
    button.addEventListener("click", () => sort(table, heading, column));
    heading.append(button);
  });
}

function makeFilter(table) {
  const rows = [...table.tBodies[0].rows].map((row) => [row, row.textContent.toLowerCase()]);
  const box = document.createElement("input");
  Object.assign(box, { type: "search", className: "filter", placeholder: "Filter", ariaLabel: "Filter the rows" });
  const count = document.createElement("output");
  const show = () => {
    const filter = box.value.trim().toLowerCase();
    let left = 0;
    for (const [row, text] of rows) {
      row.hidden = !text.includes(filter);
      left += Number(!row.hidden);
    }
    count.textContent = filter ? `${left} of ${rows.length} rows` : "";
  };
  box.addEventListener("input", show);
  // A link may lead to a row that is filtered out.
  addEventListener("hashchange", () => {
    if (!table.querySelector("tr:target[hidden]")) return;
    box.value = "";
    show();
  });
  const line = document.createElement("p");
  line.className = "filtering";
  line.append(box, count);
  (table.closest(".wide") ?? table).before(line);
}

for (const table of document.querySelectorAll("table.sheet")) {
  if (table.tBodies[0].rows.length < 2) continue;
  makeSortable(table);
  if (table.tBodies[0].rows.length >= LONG) makeFilter(table);
}
