//! A precaution before WebCodecs is used.

/** WebKit on Linux (2.50) starts its media library for `<video>`, but not for WebCodecs: a page that uses that first crashes. */
export function startMedia(): void {
  document.createElement('video').canPlayType('video/webm');
}
