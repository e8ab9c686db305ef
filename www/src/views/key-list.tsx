//! The list of the keyboard shortcuts, in groups. Loaded when it is first opened.

import { render } from 'preact';

/** The keys about one thing, each as it is shown, with its effect in words: none if that is the one of the key before it. */
interface Group {
  readonly title: string;
  readonly keys: readonly (readonly [string, string])[];
}

const GROUPS: readonly Group[] = [
  {
    title: 'Frames',
    keys: [
      ['→', 'Step forward'],
      ['.', ''],
      ['←', 'Step back'],
      [',', ''],
      ['Shift →', 'Step ten frames forward, or back'],
      ['Shift ←', ''],
      ['Space', 'Play the clip, or stop'],
      ['K', ''],
      ['J', 'Play slower'],
      ['Shift J', 'Play faster'],
      ['I', 'In point: segment the clip from this frame on'],
      ['O', 'Out point: segment the clip up to this frame'],
    ],
  },
  {
    title: 'Review',
    keys: [
      ['D', 'Next frame where an object is least certain'],
      ['Shift D', 'Previous frame where an object is least certain'],
      ['N', 'Frame that the last correction changed most; again, the next one'],
      ['C', 'Next corrected frame'],
      ['Shift C', 'Previous corrected frame'],
      ['Y', 'Accept the masks of this frame, and go to the frame that most needs a look'],
      ['Shift Y', 'Accept the masks of all frames'],
    ],
  },
  {
    title: 'Tools',
    keys: [
      ['V', 'View: select masks, pan'],
      ['B', 'Brush: add to the selected mask'],
      ['E', 'Eraser: remove from the selected mask'],
      ['W', 'Polygon: its inside is the selected object here, and if exact is added to it; Enter closes it, with Shift to remove, Backspace takes a corner back'],
      ['X', 'Box: make a new object of a clip; again, add to the selected one or remove from it, as a press with Shift or Alt does'],
      ['[', 'Smaller brush'],
      [']', 'Larger brush'],
      ['Q', 'Exact: what is drawn is kept pixel for pixel, and nothing follows'],
      ['Ctrl Z', 'Undo'],
      ['Ctrl Shift Z', 'Redo'],
      ['Ctrl Y', ''],
      ['Esc', 'Cancel'],
    ],
  },
  {
    title: 'Masks',
    keys: [
      ['1 … 9', 'Select a mask by its place in the list'],
      ['F2', 'Rename the selected mask, as a double click on its name does'],
      ['T', 'Class of the selected objects'],
      ['Shift L', 'Lock the selected objects, or unlock them'],
      ['Delete', 'Delete the selected objects'],
      ['>', 'Copy the selected mask to the next frame'],
      ['<', 'Copy the selected mask to the frame before'],
    ],
  },
  {
    title: 'What is shown',
    keys: [
      ['F', 'Show the other frame while held'],
      ['Shift F', 'Alternate between the frames'],
      ['S', 'Split view'],
      ['G', 'Motions between this frame and the next'],
      ['L', 'Outlines'],
      ['U', 'Onion skin: outlines of the objects in the frames before and after'],
      ['+', 'Zoom in'],
      ['−', 'Zoom out'],
      ['0', 'Fit the picture'],
      ['Z', 'Zoom to 100 %'],
      ['?', 'Show this list'],
    ],
  },
  {
    title: 'With the picture focused by Tab',
    keys: [
      ['←', 'Pan the enlarged picture, or move the brush'],
      ['→', ''],
      ['↑', ''],
      ['↓', ''],
      ['Space', 'Start or end a stroke or a box, set a corner'],
    ],
  },
];

export function listKeys(root: HTMLElement): void {
  render(
    <>
      {GROUPS.map(({ title, keys }) => (
        <section key={title}>
          <h3>{title}</h3>
          <dl>
            {rowsOf(keys).map(({ shown, does }) => (
              <div key={does}>
                <dt>
                  {shown.map((key, k) => (
                    <>
                      {k > 0 && ' '}
                      <kbd>{key}</kbd>
                    </>
                  ))}
                </dt>
                <dd>{does}</dd>
              </div>
            ))}
          </dl>
        </section>
      ))}
    </>,
    root,
  );
}

/** Keys with the same effect are one row. */
function rowsOf(keys: Group['keys']): { readonly shown: string[]; readonly does: string }[] {
  const rows: { readonly shown: string[]; readonly does: string }[] = [];
  for (const [key, does] of keys) {
    if (does === '') rows.at(-1)!.shown.push(key);
    else rows.push({ shown: [key], does });
  }
  return rows;
}
