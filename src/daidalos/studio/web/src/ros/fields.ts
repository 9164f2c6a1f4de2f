// Paths into messages, as plots name them: /odom/pose/pose/position/x, /scan/ranges/0 or /scan/ranges[0].

/** Split a path into its topic and its fields. */
export function splitPath(path: string, topics: Iterable<string>): { topic: string; fields: string[] } | undefined {
  let topic = "";
  for (const name of topics) {
    if ((path === name || path.startsWith(`${name}/`)) && name.length > topic.length) {
      topic = name;
    }
  }
  return topic ? { topic, fields: fieldsIn(path.slice(topic.length)) } : undefined;
}

/** The names of fields and the numbers of elements, which may be written as /0 or as [0]. */
function fieldsIn(path: string): string[] {
  return path
    .replace(/\[(\d+)\]/g, "/$1/")
    .split(/[/.]/)
    .filter(Boolean);
}

/** The number at a path; undefined where there is none. */
export function numberAt(message: unknown, fields: readonly string[]): number | undefined {
  let value = message;
  for (const field of fields) {
    if (typeof value !== "object" || value === null) {
      return undefined;
    }
    value = (value as Record<string, unknown>)[field];
  }
  switch (typeof value) {
    case "number":
      return value;
    case "bigint":
    case "boolean":
      return Number(value);
  }
  return undefined;
}

export function isTypedArray(value: unknown): value is ArrayLike<number | bigint> & ArrayBufferView {
  return ArrayBuffer.isView(value) && !(value instanceof DataView);
}
