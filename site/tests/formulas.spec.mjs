// Formulas of the explainer: their numbers, what follows them, and those that are wider than a phone.

import { expect, test } from '@playwright/test';

for (const width of [320, 390, 1280]) {
  test(`formulas are whole on ${width} pixels`, async ({ page }) => {
    await page.setViewportSize({ width, height: 844 });
    await page.goto('method/');
    const numbers = await page.locator('.numbered > .number').evaluateAll((all) =>
      all.map((one) => {
        const { left, right } = one.getBoundingClientRect();
        return { text: one.textContent.replaceAll('\u00a0', ' '), seen: left >= 0 && right <= document.documentElement.clientWidth && one.scrollWidth <= one.clientWidth + 1 };
      }),
    );
    expect(numbers.filter(({ seen }) => !seen)).toEqual([]);
    expect(numbers.map(({ text }) => text)).toEqual(expect.arrayContaining(['(3)', '(12)', '(13, 14)', '(19)']));
    expect(await page.locator('math mtext', { hasText: /^\(\d/ }).count(), 'numbers within formulas').toBe(0);

    const broken = await page.locator('article .katex:not(.katex-block > *)').evaluateAll((all) =>
      all.flatMap((formula) => {
        const text = formula.nextSibling;
        if (text?.nodeType !== Node.TEXT_NODE || !/^[.,;:)]/.test(text.data)) return [];
        const range = document.createRange();
        range.setStart(text, 0);
        range.setEnd(text, 1);
        const [sign, box] = [range.getBoundingClientRect(), formula.querySelector('math').getBoundingClientRect()];
        return [{ text: formula.textContent + text.data.slice(0, 5), apart: sign.left < box.right - 3 || sign.top > box.bottom || sign.bottom < box.top }];
      }),
    );
    expect(broken.length).toBeGreaterThan(30);
    expect(broken.filter(({ apart }) => apart)).toEqual([]);

    for (const wide of await page.locator('math[display="block"]').all()) {
      if (!(await wide.evaluate((one) => one.scrollWidth > one.clientWidth))) continue;
      await expect(wide).toHaveAttribute('tabindex', '0');
      await wide.focus();
      await page.keyboard.press('End');
      await wide.press('ArrowRight');
      await expect.poll(() => wide.evaluate((one) => one.scrollLeft)).toBeGreaterThan(0);
    }
  });
}
