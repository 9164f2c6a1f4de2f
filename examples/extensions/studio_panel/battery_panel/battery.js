// Shows the state of charge of a battery (sensor_msgs/msg/BatteryState).
const TOPIC = "/battery_state";

/** @type {import("./daidalos-studio").Panel} */
export default {
  title: "Battery",

  mount(element, { studio, visible }) {
    const meter = document.createElement("meter");
    Object.assign(meter, { min: 0, max: 1, low: 0.2, optimum: 1 });
    const text = document.createElement("output");
    element.replaceChildren(meter, text);

    let unsubscribe = () => {};
    const stopWatching = visible.subscribe((isVisible) => {
      unsubscribe();
      unsubscribe = isVisible ? studio.session.subscribe(TOPIC, 1, show) : () => {};
    });

    /** @param {import("./daidalos-studio").sensor_msgs.BatteryState} battery */
    function show({ percentage, voltage }) {
      meter.value = percentage;
      text.value = `${Math.round(100 * percentage)} %, ${voltage.toFixed(1)} V`;
    }

    return () => {
      stopWatching();
      unsubscribe();
    };
  },
};
