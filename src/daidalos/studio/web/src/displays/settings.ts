// A display's settings as data: what can be set, how it is shown, and how it is kept.

export type Value = string | number | boolean;
export type Settings = Readonly<Record<string, Value>>;

interface PropertyBase {
  key: string;
  label: string;
  /** Shown only where another setting makes it matter. */
  when?: (settings: Settings) => boolean;
}

export type Property = PropertyBase &
  (
    | { kind: "topic" }
    | { kind: "toggle" }
    | { kind: "color" }
    | { kind: "number"; min: number; max: number; step: number; unit?: string }
    | { kind: "choice"; options: readonly (readonly [value: string, label: string])[] }
  );

export interface DisplayConfig {
  readonly id: string;
  /** RViz's class without its package, e.g. LaserScan. */
  readonly type: string;
  readonly name: string;
  readonly enabled: boolean;
  readonly settings: Settings;
}

export const text = (settings: Settings, key: string): string => String(settings[key] ?? "");
export const number = (settings: Settings, key: string): number => Number(settings[key] ?? 0);
export const flag = (settings: Settings, key: string): boolean => Boolean(settings[key]);
