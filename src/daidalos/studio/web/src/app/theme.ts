// Dark or light, for the document and for what is drawn on canvases.
import { effect } from "@preact/signals";
import { stored } from "./stored";

export type Theme = "dark" | "light";

export const theme = stored<Theme>("theme", "dark", (value): value is Theme => value === "dark" || value === "light");

effect(() => {
  document.documentElement.dataset.theme = theme.value;
});

export function toggleTheme(): void {
  theme.value = theme.value === "dark" ? "light" : "dark";
}

/** A colour of the style sheet, for canvases. */
export function cssColor(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}
