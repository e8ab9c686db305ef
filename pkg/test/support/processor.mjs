// What work costs.

/** Starts to count seconds of a processor, which others on the machine do not change; the result says how many they are. */
export function stopwatch() {
  const started = process.cpuUsage();
  return () => {
    const { user, system } = process.cpuUsage(started);
    return (user + system) / 1e6;
  };
}
