// One number for all labels, the same in every runtime: SHA-256 by what they all have.

export async function labelHash({ labels }) {
  const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', labels));
  return Array.from(digest, (byte) => byte.toString(16).padStart(2, '0')).join('');
}
