// The kinds of displays: adding one means a file in ./types.
import type { DisplayType } from "../contract";
import { Registry, type Registered } from "../registry";

export const DISPLAYS = new Registry<DisplayType & { readonly title?: string }>(
  import.meta.glob<Registered<DisplayType>>(["./types/*.ts", "!./types/*.test.ts"], { eager: true, import: "default" }),
);

/** The display that shows a message type, where there is one. */
export function displayFor(message: string): Registered<DisplayType> | undefined {
  return DISPLAYS.list.find(({ discovery, messages }) => discovery !== "hidden" && messages.includes(message));
}
