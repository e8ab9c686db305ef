globalThis.outcome = new Promise((resolve) => {
  const worker = new Worker('/in-worker.js', { type: 'module' });
  worker.onmessage = ({ data }) => resolve({ direct: data });
  worker.onerror = ({ message }) => resolve({ error: message });
});
