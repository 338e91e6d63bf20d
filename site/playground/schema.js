// Keys and values that the JSON Schema of scenarios has at a place.

export class Schema {
  constructor(schema) {
    this.schema = schema;
  }

  // All forms that a place may have.
  *forms(node, depth = 0) {
    if (!node || typeof node !== "object" || depth > 12) return;
    if (node.$ref) yield* this.forms(this.schema.$defs[node.$ref.split("/").at(-1)], depth + 1);
    for (const group of ["oneOf", "anyOf", "allOf"]) {
      for (const one of node[group] ?? []) yield* this.forms(one, depth + 1);
    }
    if (node.items) yield* this.forms(node.items, depth + 1);
    yield node;
  }

  at(path) {
    let nodes = [this.schema];
    for (const step of path.map((one) => one.replace(/\[.*\]/, ""))) {
      nodes = nodes.flatMap((node) => [...this.forms(node)].flatMap((form) => form.properties?.[step] ?? []));
    }
    return nodes;
  }

  // Keys at a place, with their meanings.
  keys(path) {
    const found = new Map();
    for (const node of this.at(path)) {
      for (const form of this.forms(node)) {
        for (const [key, own] of Object.entries(form.properties ?? {})) {
          if (key !== "own") found.set(key, own.description ?? form.description ?? "");
        }
      }
    }
    return [...found].map(([key, meaning]) => ({ key, meaning }));
  }

  // Words that a value may be.
  values(path) {
    const found = new Map();
    for (const node of this.at(path)) {
      for (const form of this.forms(node)) {
        for (const word of [form.const, ...(form.enum ?? [])]) {
          if (typeof word === "string") found.set(word, form.description ?? "");
        }
        if (form.type === "boolean") for (const word of [true, false]) found.set(word, "");
      }
    }
    return [...found].map(([word, meaning]) => ({ word, meaning }));
  }

  // The meaning of a key, with its default.
  meaning(path) {
    for (const node of this.at(path)) {
      const text = node.description ?? [...this.forms(node)].find((form) => form.description)?.description;
      const preset = node.default === undefined ? "" : ` Default: ${JSON.stringify(node.default)}.`;
      if (text) return text + preset;
    }
    return "";
  }
}
