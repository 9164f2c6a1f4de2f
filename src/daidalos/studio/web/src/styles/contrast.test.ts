import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";

const SHEET = readFileSync(new URL("./theme.css", import.meta.url), "utf8");
const LEAST = 4.5; // WCAG 2.2, 1.4.3

function colorsOf(theme: string): Record<string, string> {
  const block = SHEET.split(`[data-theme="${theme}"] {`)[1]?.split("}")[0] ?? "";
  return Object.fromEntries(
    [...block.matchAll(/--([\w-]+): (#[0-9a-f]{6});/g)].map(([, name, color]) => [name, color]),
  );
}

function luminance(color: string): number {
  const [r, g, b] = [1, 3, 5].map((at) => {
    const share = Number.parseInt(color.slice(at, at + 2), 16) / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  }) as [number, number, number];
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

function contrast(a: string, b: string): number {
  const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y) as [number, number];
  return (high + 0.05) / (low + 0.05);
}

describe.each(["dark", "light"])("in the %s theme", (theme) => {
  const colors = colorsOf(theme);
  it.each(
    ["text", "text-soft", "text-faint", "accent", "ok", "warning", "error"].flatMap((text) =>
      ["surface", "raised"].map((on) => [text, on]),
    ),
  )("--%s is legible on --%s", (text, on) => {
    expect(contrast(colors[text as string] as string, colors[on as string] as string)).toBeGreaterThanOrEqual(LEAST);
  });
});
