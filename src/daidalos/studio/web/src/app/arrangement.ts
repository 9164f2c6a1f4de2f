// What the page shows when a file of RViz or PlotJuggler was opened (studio/arrangement.py).
import { DISPLAYS } from "../displays/registry";
import type { DisplayConfig } from "../displays/settings";
import type { Arrangement, Plot, Split } from "../generated/arrangement";
import { openedFile } from "./files";

const ADDRESS = "arrangement.json";

/** The layout of a file that was opened in this window, or that the server was started with; undefined: none. */
export async function fetchArrangement(name: string): Promise<Arrangement | undefined> {
  const opened = openedFile(name);
  if (opened) {
    return opened;
  }
  const answer = await fetch(ADDRESS).catch(() => undefined);
  return answer?.ok ? ((await answer.json()) as Arrangement) : undefined;
}

/** The displays of an arrangement, with the default where it has no value. */
export function displaysOf({ displays }: Arrangement): DisplayConfig[] | undefined {
  return displays?.map(({ settings, ...display }, i) => {
    // One that the page does not have stays in the list, and in the file when it is saved.
    const defaults = DISPLAYS.find(display.type)?.defaults ?? {};
    return { ...display, id: `arranged-${i}`, settings: { ...defaults, ...settings } };
  });
}

export function isSplit(content: Plot | Split): content is Split {
  return "parts" in content;
}

/** The first plot of a split, which stands for all of it while the others are not placed. */
export function firstPlot(content: Plot | Split): Plot {
  const [first] = isSplit(content) ? content.parts : [];
  return isSplit(content) ? (first ? firstPlot(first) : { curves: [], origin: "" }) : content;
}

export function allPlots(content: Plot | Split): readonly Plot[] {
  return isSplit(content) ? content.parts.flatMap(allPlots) : [content];
}
