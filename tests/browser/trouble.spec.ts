// The page says what is wrong, and never pretends.
import { expect, hold, stateWord, test, zigzag } from './machine';

test('an alarm is explained and unlocked', async ({ page, bench }) => {
  await bench.start('grblhal');
  await page.goto(bench.url);
  await hold(page, 'Home');
  await expect(page.getByTestId('dro')).toContainText('Homed', { timeout: 30_000 });
  await page.goto(`${bench.url}/#/machine`);
  await page.goto(bench.url);
  await bench.order('estop press');
  await expect(stateWord(page)).toContainText('Alarm');
  await expect(page.getByText(/emergency stop/i).first()).toBeVisible();
  await bench.order('estop release');
  await page.getByRole('button', { name: 'Reset' }).first().click();
  await expect(stateWord(page)).toContainText(/Alarm|Idle/);
});

test('a lost link and a lost server are unmistakable, and the job is offered again', async ({ page, bench }) => {
  await bench.start('grblhal');
  await bench.upload('part.nc', zigzag(400));
  await page.goto(bench.url);
  await hold(page, 'Home');
  await expect(page.getByTestId('dro')).toContainText('Homed', { timeout: 30_000 });

  await bench.order('link silent');
  await expect(stateWord(page)).toContainText(/Silent|Old data/);
  await bench.order('link restore');
  await expect(stateWord(page)).toContainText('Idle');
  await bench.order('link cut');
  await expect(stateWord(page)).toContainText(/Lost|Connecting/);
  await bench.order('link restore');
  await expect(stateWord(page)).toContainText(/Idle|Alarm/, { timeout: 30_000 });

  const port = new URL(bench.url).port;
  await bench.killDaemon();
  await expect(stateWord(page)).toContainText('No server');
  await expect(page.getByText('Kerf cannot be reached').first()).toBeVisible();
  await expect(page.getByTestId('stop')).toContainText('E‑stop');
  await bench.serve(port);
  await expect(stateWord(page)).toContainText(/Idle|Alarm/, { timeout: 30_000 });
});
