// Where the cursor is in a scenario: the table, the path of the key, and numbers.

const HEADER = /^\s*\[+\s*([^\]]+?)\s*\]+/;

// The path of a key, without indices and quotes: `sensor.gyro.period`.
const steps = (path) => path.split(".").map((step) => step.trim().replace(/["']/g, "")).filter(Boolean);

// What stands before a position: the path of the table and of inline tables around it, whether a value is due, and the word.
export function contextAt(text, position) {
  const lines = text.slice(0, position).split("\n");
  let table = [];
  for (const line of lines.slice(0, -1)) {
    const header = HEADER.exec(line);
    if (header) table = steps(header[1]);
  }
  const last = lines.at(-1);
  const opened = /^\s*\[+([\w.]*)$/.exec(last);
  if (opened) return { path: [], word: opened[1], isValue: false, isHeader: true };
  const own = HEADER.exec(last);
  if (own) return { path: steps(own[1]), word: "", isValue: false, isHeader: true };
  // The statement may have begun on an earlier line, within brackets.
  let start = lines.length - 1;
  while (start > 0 && !/^\s*[\w."\-]+\s*=/.test(lines[start]) && !HEADER.test(lines[start])) start -= 1;
  const statement = (HEADER.test(lines[start]) ? last : lines.slice(start).join("\n")).replace(/#[^\n]*/g, "");
  const stack = [[]];
  let key = "";
  let isValue = false;
  for (const token of statement.match(/"[^"]*"?|'[^']*'?|[{}[\],=]|[\w.+\-]+/g) ?? []) {
    if (token === "=") isValue = true;
    else if (token === "{") {
      stack.push([...stack.at(-1), ...steps(key)]);
      [key, isValue] = ["", false];
    } else if (token === "}") {
      if (stack.length > 1) stack.pop();
      isValue = true;
    } else if (token === ",") isValue = stack.length === 1;
    else if (!isValue) key = token;
  }
  const word = /[\w.]*$/.exec(last)[0];
  const path = [...table, ...stack.at(-1)];
  if (isValue) return { path: [...path, ...steps(key)], word, isValue, isHeader: false };
  const within = word.split(".");
  return { path: [...path, ...within.slice(0, -1)], word: within.at(-1), isValue, isHeader: false };
}

const NUMBER = /[-+]?(?:\d[\d_]*\.?\d*|\.\d+)(?:[eE][-+]?\d+)?/g;

// The number of a line that contains a column, or the first after it, as { from, to, value, unit }.
export function numberAt(line, column, isExact = true) {
  const end = commentStart(line);
  for (const match of line.slice(0, end).matchAll(NUMBER)) {
    const [from, to] = [match.index, match.index + match[0].length];
    const before = line[from - 1] ?? " ";
    if (/[\w.\-:]/.test(before) || /[\w:\-]/.test(line[to] ?? " ") || (isExact ? column < from || column > to : to < column)) continue;
    const unit = /^ +([^"\]},]+)"/.exec(line.slice(to))?.[1] ?? "";
    return { from, to, value: Number(match[0].replaceAll("_", "")), unit };
  }
  return null;
}

function commentStart(line) {
  let quoted = false;
  for (let place = 0; place < line.length; place += 1) {
    if (line[place] === '"') quoted = !quoted;
    if (line[place] === "#" && !quoted) return place;
  }
  return line.length;
}

// A number as a person writes it, to four digits.
export const written = (value) => String(Number(value.toPrecision(4)));
