//! One tab keeps the work on a clip: the first that has any. What another tab did would be overwritten, or would overwrite it.

const owned = new Set<string>();

/**
 * Whether this tab keeps the work on this clip: it does already, or no other does and `isUpToDate`. It then does until it is closed.
 * Browsers without locks know no other tabs.
 */
export async function owns(of: string, isUpToDate: () => Promise<boolean>): Promise<boolean> {
  if (owned.has(of) || !('locks' in navigator)) return true;
  return new Promise((resolve, reject) => {
    const take = async (lock: Lock | null): Promise<void> => {
      const own = lock !== null && (await isUpToDate());
      if (own) owned.add(of);
      resolve(own);
      // The lock is held as long as this promise is pending.
      if (own) await new Promise(() => undefined);
    };
    navigator.locks.request(lockOf(of), { ifAvailable: true }, take).catch(reject);
  });
}

/** Whether this tab keeps the work on this clip. */
export function isOwn(of: string): boolean {
  return owned.has(of);
}

/** Whether a tab keeps the work on this clip. */
export async function isOwned(of: string): Promise<boolean> {
  if (!('locks' in navigator)) return false;
  const { held = [] } = await navigator.locks.query();
  return held.some(({ name }) => name === lockOf(of));
}

function lockOf(of: string): string {
  return `veronese project ${of}`;
}
