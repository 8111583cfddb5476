// The pictures of docs/screens: only when KERF_SCREENS names the folder (`make screens`).
import { mkdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from '@playwright/test';
import { type Bench, expect, hold, stateWord, test } from './machine';

const folder = process.env.KERF_SCREENS;
const part = readFileSync(join(__dirname, '../../examples/coaster.nc'), 'utf8');

async function choose(page: Page, bench: Bench, theme: string) {
  await page.addInitScript((wanted) => {
    const key = Object.keys(localStorage).find((name) => name.includes('kerf')) ?? 'kerf';
    localStorage.setItem(key, JSON.stringify({ ...JSON.parse(localStorage.getItem(key) ?? '{}'), theme: wanted }));
  }, theme);
  await page.goto(bench.url);
  await expect(stateWord(page)).not.toContainText('Connecting');
  await page.waitForTimeout(2500);
}

test('pictures of the page', async ({ page, bench }) => {
  test.skip(!folder, 'KERF_SCREENS names no folder');
  test.setTimeout(240_000);
  mkdirSync(folder!, { recursive: true });
  const shot = (name: string) => page.screenshot({ path: join(folder!, `${name}.png`) });

  await bench.start('grblhal', '1');
  await bench.upload('coaster.nc', part);
  await choose(page, bench, 'dark');
  await page.getByRole('link', { name: 'Jobs' }).click();
  await page.getByRole('button', { name: 'Load coaster.nc' }).click();
  await page.getByRole('link', { name: 'Control' }).click();
  await hold(page, 'Home');
  await expect(page.getByTestId('dro')).toContainText('Homed', { timeout: 60_000 });
  const { limits } = await bench.state();
  await bench.command('GoTo', { system: 'Machine', position: { X: limits.min_mm[0] + 30, Y: limits.min_mm[1] + 35, Z: -40 } });
  await page.waitForTimeout(3000);
  await expect(stateWord(page)).toContainText('Idle', { timeout: 30_000 });
  await bench.command('SetZero', { axes: 'XYZ' });
  await page.waitForTimeout(1500);
  await hold(page, 'Start', page.getByTestId('job-bar'));
  await expect(stateWord(page)).toContainText('Running');
  await page.waitForTimeout(25_000);
  await shot('control');

  for (const [name, width, height] of [['control-tablet', 1024, 768], ['control-phone', 390, 844]] as const) {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(1200);
    await shot(name);
  }
  await page.setViewportSize({ width: 1440, height: 900 });
  for (const theme of ['light', 'goggle']) {
    await choose(page, bench, theme);
    await shot(`control-${theme}`);
  }
  await choose(page, bench, 'dark');
  await page.getByRole('link', { name: 'Jobs' }).click();
  await page.waitForTimeout(1000);
  await shot('jobs');
  await page.getByRole('link', { name: 'Machine' }).click();
  for (const tab of ['Settings', 'Console']) {
    await page.getByRole('tab', { name: tab }).click();
    await page.waitForTimeout(1200);
    await shot(`machine-${tab.toLowerCase()}`);
  }
  await page.getByRole('link', { name: 'Control' }).click();
  await bench.order('door open');
  await expect(stateWord(page)).toContainText('Door');
  await page.waitForTimeout(1500);
  await shot('door');
  await bench.order('door close');
  await bench.order('estop press');
  await expect(stateWord(page)).toContainText('Alarm');
  await page.waitForTimeout(1500);
  await shot('alarm');
  await bench.killDaemon();
  await expect(stateWord(page)).toContainText('No server');
  await page.waitForTimeout(1500);
  await shot('no-server');
});
