// Every page, on every size of screen and in every theme: nothing serious for those who cannot see it well, Stop in reach.
import AxeBuilder from '@axe-core/playwright';
import { expect, hold, stateWord, test, zigzag } from './machine';

const sizes = { desktop: [1440, 900], tablet: [1024, 768], phone: [390, 844] } as const;

test('have nothing serious for axe, and Stop in reach', async ({ page, bench }) => {
  await bench.start('grblhal');
  await bench.upload('part.nc', zigzag(20));
  const messages: string[] = [];
  page.on('pageerror', (error) => messages.push(String(error)));
  page.on('console', (message) => message.type() === 'error' && messages.push(message.text()));
  for (const [size, [width, height]] of Object.entries(sizes)) {
    await page.setViewportSize({ width, height });
    for (const theme of ['dark', 'light']) {
      await page.goto(bench.url);
      await page.evaluate((wanted) => {
        const key = Object.keys(localStorage).find((name) => name.includes('kerf')) ?? 'kerf';
        localStorage.setItem(key, JSON.stringify({ ...JSON.parse(localStorage.getItem(key) ?? '{}'), theme: wanted }));
      }, theme);
      for (const name of ['Control', 'Jobs', 'Machine']) {
        await page.goto(bench.url);
        await expect(stateWord(page)).toContainText(/Idle|Alarm/);
        await page.getByRole('link', { name }).click();
        await page.waitForTimeout(300);
        const stop = await page.getByTestId('stop').boundingBox();
        expect(stop!.height, `${size} ${name}`).toBeGreaterThanOrEqual(48);
        expect(stop!.x + stop!.width).toBeLessThanOrEqual(width);
        const found = await new AxeBuilder({ page }).analyze();
        const serious = found.violations.filter((one) => one.impact === 'serious' || one.impact === 'critical');
        expect(serious.map((one) => `${size} ${theme} ${name}: ${one.id} ${one.nodes[0].html}`)).toEqual([]);
      }
    }
  }
  expect(messages).toEqual([]);
});

test('settings are what the machine says, changed and rolled back', async ({ page, bench }) => {
  await bench.start('grblhal');
  await page.goto(bench.url);
  await expect(stateWord(page)).toContainText(/Idle|Alarm/);
  await page.getByRole('link', { name: 'Machine' }).click();
  await page.getByRole('tab', { name: 'Settings' }).click();
  const settings = page.getByTestId('settings');
  await settings.getByRole('searchbox').or(settings.getByRole('textbox').first()).first().fill('$110');
  const field = settings.getByRole('textbox', { name: /110|rate/i }).or(settings.getByRole('spinbutton')).last();
  await field.fill('4321');
  await hold(page, 'Write');
  const rate = async () => (await bench.state()).limits.max_feed_mm_per_min[0];
  await expect.poll(rate).toBe(4321);
  await hold(page, /Roll back to version/);
  await expect.poll(rate).toBe(6000);
});
