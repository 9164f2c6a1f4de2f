// Values of parameters, between rcl_interfaces' messages and what the page edits.
import { type ParameterDescriptor, ParameterType, type ParameterValue } from "../generated/rcl_interfaces";

export type Value = boolean | number | string | boolean[] | number[] | string[] | undefined;

export interface Parameter {
  /** With dots, without the node. */
  readonly name: string;
  /** One of ParameterType. */
  readonly type: number;
  readonly value: Value;
  readonly description: string;
  /** Empty where the descriptor has none. */
  readonly unit: string;
  /** Rules in words, such as "above 0, at most 1". */
  readonly constraints: string;
  /** The allowed texts or numbers; empty where it is not one of few. */
  readonly choices: readonly string[];
  /** The allowed numbers; infinite where there is no bound. */
  readonly lower: number;
  readonly upper: number;
  /** 0: any number between them. */
  readonly step: number;
  readonly isReadOnly: boolean;
}

type ValueField = Exclude<keyof ParameterValue, "type">;

const FIELDS: Readonly<Record<number, ValueField>> = {
  [ParameterType.PARAMETER_BOOL]: "bool_value",
  [ParameterType.PARAMETER_INTEGER]: "integer_value",
  [ParameterType.PARAMETER_DOUBLE]: "double_value",
  [ParameterType.PARAMETER_STRING]: "string_value",
  [ParameterType.PARAMETER_BYTE_ARRAY]: "byte_array_value",
  [ParameterType.PARAMETER_BOOL_ARRAY]: "bool_array_value",
  [ParameterType.PARAMETER_INTEGER_ARRAY]: "integer_array_value",
  [ParameterType.PARAMETER_DOUBLE_ARRAY]: "double_array_value",
  [ParameterType.PARAMETER_STRING_ARRAY]: "string_array_value",
};
const UNIT = /\s*\[([^\]]+)\]$/;
const CHOICES = /(?:^|, )one of (.+?)(?:, \d+ elements|, not empty|, no duplicates)*$/;

export function isInteger(type: number): boolean {
  return type === ParameterType.PARAMETER_INTEGER || type === ParameterType.PARAMETER_INTEGER_ARRAY;
}

export function isArray(type: number): boolean {
  return type >= ParameterType.PARAMETER_BYTE_ARRAY;
}

/** Read a value; undefined where the parameter is not set. */
export function fromMessage(message: ParameterValue): Value {
  const field = FIELDS[message.type];
  const value = field && message[field];
  if (typeof value === "bigint") {
    return Number(value);
  }
  return ArrayBuffer.isView(value) ? Array.from(value as ArrayLike<number | bigint>, Number) : value;
}

/** Write a value of a parameter of this type. */
export function toMessage(type: number, value: Value): Partial<ParameterValue> {
  const integer = (number: unknown) => BigInt(Math.round(Number(number)));
  const content = isInteger(type) ? (Array.isArray(value) ? value.map(integer) : integer(value)) : value;
  return { type, [FIELDS[type] as ValueField]: content };
}

/** Combine a parameter's value with its descriptor. */
export function describe(name: string, value: ParameterValue, descriptor?: ParameterDescriptor): Parameter {
  const {
    description = "",
    additional_constraints: constraints = "",
    read_only: isReadOnly = false,
  } = descriptor ?? {};
  const range = descriptor?.floating_point_range?.[0] ?? descriptor?.integer_range?.[0];
  return {
    name,
    type: value.type,
    value: fromMessage(value),
    description: description.replace(UNIT, ""),
    unit: UNIT.exec(description)?.[1] ?? "",
    constraints,
    choices: CHOICES.exec(constraints)?.[1]?.split(", ") ?? [],
    lower: range ? bound(range.from_value) : -Infinity,
    upper: range ? bound(range.to_value) : Infinity,
    step: range ? Number(range.step ?? 0) : 0,
    isReadOnly,
  };
}

/** The ends of 64-bit integers stand for no bound. */
function bound(value: number | bigint): number {
  const number = Number(value);
  return typeof value === "bigint" && !Number.isSafeInteger(number) ? Math.sign(number) * Infinity : number;
}
