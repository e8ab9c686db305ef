// CHANGELOG.md: its newest section is of the version that is released, and dated.

/** The newest section: its name, and what stands where the date belongs. */
export function newestSection(text) {
  const heading = /^## \[?([^\]\s]+)\]?(?: +[–-] +(.+))?$/m.exec(text);
  return heading ? { name: heading[1], date: heading[2]?.trim() } : undefined;
}

/**
 * Whether the changelog is ready: `{ problem }`, `{ todo }` (only a rehearsal may leave this open) or neither. A section that is not
 * finished is called "Unreleased", or has "unreleased" for a date.
 */
export function changelogState(text, version, today) {
  const section = newestSection(text);
  if (!section) return { problem: 'CHANGELOG.md has no section: the newest one begins with `## [X.Y.Z] – YYYY-MM-DD`.' };
  const dated = `\`## [${version}] – ${today}\``;
  if (/^unreleased$/i.test(section.name)) return { todo: `CHANGELOG.md begins with "Unreleased": a release writes ${dated} there.` };
  if (section.name !== version) return { problem: `CHANGELOG.md begins with ${section.name}, and the version is ${version}.` };
  if (/^unreleased$/i.test(section.date ?? '')) return { todo: `CHANGELOG.md has ${version} as unreleased: a release writes ${dated} there.` };
  if (!section.date) return { problem: `CHANGELOG.md has no date for ${version}: write ${dated}, or "unreleased" for the date.` };
  if (!isDate(section.date)) return { problem: `CHANGELOG.md has '${section.date}' as the date of ${version}: write ${dated}.` };
  return {};
}

/** A day of the calendar as YYYY-MM-DD. */
function isDate(text) {
  const day = new Date(`${text}T00:00:00Z`);
  return !Number.isNaN(day.getTime()) && day.toISOString().slice(0, 10) === text;
}
