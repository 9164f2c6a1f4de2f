import { expect, it } from "vitest";
import { ParameterType, type ParameterDescriptor, type ParameterValue } from "../generated/rcl_interfaces";
import { describe, fromMessage, toMessage } from "./values";

const message = (content: Partial<ParameterValue>) => content as ParameterValue;
const described = (content: Partial<ParameterDescriptor>) =>
  describe("p", message({ type: ParameterType.PARAMETER_DOUBLE, double_value: 1 }), content as ParameterDescriptor);

it.each([
  [{ type: ParameterType.PARAMETER_BOOL, bool_value: true }, true],
  [{ type: ParameterType.PARAMETER_INTEGER, integer_value: 7n }, 7],
  [{ type: ParameterType.PARAMETER_DOUBLE, double_value: 0.5 }, 0.5],
  [{ type: ParameterType.PARAMETER_STRING, string_value: "a" }, "a"],
  [{ type: ParameterType.PARAMETER_STRING_ARRAY, string_array_value: ["a"] }, ["a"]],
])("reads and writes %o", (content, value) => {
  expect(fromMessage(message(content))).toEqual(value);
  expect(toMessage(content.type, value)).toEqual(content);
});

it("reads and writes arrays of integers", () => {
  const type = ParameterType.PARAMETER_INTEGER_ARRAY;
  const value = fromMessage(message({ type, integer_array_value: BigInt64Array.of(1n, -2n) }));
  expect(value).toEqual([1, -2]);
  expect(toMessage(type, value)).toEqual({ type, integer_array_value: [1n, -2n] });
});

it("has no value where a parameter is not set", () => {
  expect(fromMessage(message({ type: ParameterType.PARAMETER_NOT_SET }))).toBeUndefined();
});

it("takes the unit out of the description, and the choices out of the constraints", () => {
  expect(described({ description: "Top speed [m/s]" })).toMatchObject({ description: "Top speed", unit: "m/s" });
  expect(described({ additional_constraints: "at least 0, one of a, b c" }).choices).toEqual(["a", "b c"]);
  expect(described({ additional_constraints: "one of a, b, no duplicates" }).choices).toEqual(["a", "b"]);
  expect(described({ additional_constraints: "above 0" }).choices).toEqual([]);
});

it("has the bounds of the range, and none where they are those of the type", () => {
  const floats = [{ from_value: 0, to_value: Infinity, step: 0 }];
  expect(described({ floating_point_range: floats })).toMatchObject({ lower: 0, upper: Infinity });
  const integers = [{ from_value: 1n, to_value: 2n ** 63n - 1n, step: 1n }];
  expect(described({ integer_range: integers })).toMatchObject({ lower: 1, upper: Infinity, step: 1 });
  expect(described({})).toMatchObject({ lower: -Infinity, upper: Infinity, step: 0 });
});
