// What the page shows when a file of RViz or PlotJuggler was opened (studio/arrangement.py).
import { DISPLAYS } from "../displays/registry";
import type { DisplayConfig } from "../displays/settings";
import type { Arrangement, Plot, Split } from "../generated/arrangement";

const ADDRESS = "arrangement.json";

/** Fetch the layout of the file that the server was started with; undefined where there is none or no server. */
export async function fetchArrangement(): Promise<Arrangement | undefined> {
  const answer = await fetch(ADDRESS).catch(() => undefined);
  return answer?.ok ? ((await answer.json()) as Arrangement) : undefined;
}

/** The displays of an arrangement, with the default where it has no value. */
export function displaysOf({ displays }: Arrangement): DisplayConfig[] | undefined {
  return displays?.flatMap(({ settings, ...display }, i) => {
    const type = DISPLAYS.find(display.type);
    return type ? [{ ...display, id: `arranged-${i}`, settings: { ...type.defaults, ...settings } }] : [];
  });
}

export function isSplit(content: Plot | Split): content is Split {
  return "parts" in content;
}

/** The first plot of a split, which stands for all of it while the others are not placed. */
export function firstPlot(content: Plot | Split): Plot {
  const [first] = isSplit(content) ? content.parts : [];
  return isSplit(content) ? (first ? firstPlot(first) : { curves: [] }) : content;
}

export function allPlots(content: Plot | Split): readonly Plot[] {
  return isSplit(content) ? content.parts.flatMap(allPlots) : [content];
}
