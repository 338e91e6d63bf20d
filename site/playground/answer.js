// The answer of a run as HTML, from the structure that `flexsc simulate --json` prints.

export const escaped = (text) =>
  String(text).replace(/[&<>"]/g, (letter) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[letter]);

const COLOURS = { failed: "red", missed: "red", met_but: "amber", goal_missed: "amber", met: "green" };

// A button that shows an instant in the figures.
const instant = (text, from, to) => `<button class="instant" data-from="${from}" data-to="${to}">${escaped(text)}</button>`;

// Mark and class of a decision.
const DECISIONS = { met: ["✓", "met"], missed: ["✗", "missed"], undecided: ["?", "missed"], not_exercised: ["-", ""] };

function requirement({ text, decision, name, largest }) {
  const [mark, kind] = DECISIONS[decision];
  const peak = largest ? ` ${instant(text.largest || "largest", largest.at_s, largest.at_s)}` : "";
  return (
    `<tr class="${kind}"><td>${mark}</td><th scope="row">${escaped(name)}</th>` +
    `<td>${escaped(text.value)}</td><td>at most ${escaped(text.limit)}</td>` +
    `<td>${text.margin ? `margin ${escaped(text.margin)}` : ""}${peak}</td></tr>`
  );
}

export function answerHtml({ answer, screen }) {
  const colour = COLOURS[answer.verdict] ?? "plain";
  let html = `<p class="verdict ${colour}">${escaped(answer.verdict_text)}</p>`;
  if (answer.requirements?.length) {
    html += `<table>${answer.requirements.map(requirement).join("")}</table>`;
  }
  for (const warning of answer.warnings ?? []) {
    html += `<p class="warning">! ${escaped(warning.text)}</p>`;
  }
  const rest = screen.split("\n").slice(1).join("\n").replace(/^\n+|\s+$/g, "");
  return `${html}<details ${answer.requirements?.length ? "" : "open"}><summary>all of the first screen</summary><pre>${escaped(rest)}</pre></details>`;
}
