// Messages as text that people can edit: JSON, with 64-bit integers as plain numbers.

/** Write a message. */
export function toText(message: unknown): string {
  return JSON.stringify(
    message,
    (_, value: unknown) => {
      if (typeof value === "bigint") {
        return Number.isSafeInteger(Number(value)) ? Number(value) : value.toString();
      }
      return ArrayBuffer.isView(value) ? [...(value as unknown as Iterable<number | bigint>)] : value;
    },
    2,
  );
}

/** Read a message from the text of `toText`, perhaps edited. */
export function fromText(text: string): unknown {
  return JSON.parse(text);
}
