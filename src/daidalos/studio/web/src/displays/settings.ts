// A display's settings as data: how they are kept and read.
import type { Settings } from "../contract";

export interface DisplayConfig {
  readonly id: string;
  /** RViz's class without its package, e.g. LaserScan. */
  readonly type: string;
  readonly name: string;
  readonly enabled: boolean;
  readonly settings: Settings;
  /** Its place in the file that it was read from. */
  readonly origin?: string;
}

export const text = (settings: Settings, key: string): string => String(settings[key] ?? "");
export const number = (settings: Settings, key: string): number => Number(settings[key] ?? 0);
export const flag = (settings: Settings, key: string): boolean => Boolean(settings[key]);
