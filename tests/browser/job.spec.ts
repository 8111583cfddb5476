// An operator runs a whole job from the page.
import { expect, hold, stateWord, test, zigzag } from './machine';

for (const personality of ['grblhal', 'rabbit']) {
  test(`a job from nothing on ${personality}`, async ({ page, bench }) => {
    await bench.start(personality);
    await page.goto(bench.url);

    // Nobody has homed it yet.
    await expect(stateWord(page)).toContainText(/Idle|Alarm/);
    await hold(page, 'Home');
    await expect(stateWord(page)).toContainText('Homing');
    await expect(page.getByTestId('dro')).toContainText('Homed', { timeout: 30_000 });
    await expect(stateWord(page)).toContainText('Idle');

    // Jog with the finger on the button, then by keys.
    const before = await bench.position();
    // Away from the switches, on either side of which a firmware may have its numbers.
    const found = (await bench.state()).limits;
    const inwards = (axis: number) => before[axis] < (found.min_mm[axis] + found.max_mm[axis]) / 2;
    const jog = page.getByTestId('jog-pad').getByRole('button', { name: `Jog X${inwards(0) ? '+' : '−'}`, exact: true });
    await jog.hover();
    await page.mouse.down();
    await page.waitForTimeout(900);
    await page.mouse.up();
    await expect(stateWord(page)).toContainText('Idle');
    const jogged = await bench.position();
    expect(Math.abs(jogged[0] - before[0])).toBeGreaterThan(1);
    await page.getByRole('button', { name: 'Arm the keyboard' }).click();
    const key = inwards(1) ? 'ArrowUp' : 'ArrowDown';
    await page.keyboard.down(key);
    await page.waitForTimeout(900);
    await page.keyboard.up(key);
    await expect(stateWord(page)).toContainText('Idle');
    const keyed = await bench.position();
    expect(Math.abs(keyed[1] - jogged[1])).toBeGreaterThan(1);
    await page.keyboard.press('Escape');

    // In the middle of the machine, with its zero there.
    const middle = { X: 0, Y: 0, Z: 0 } as Record<string, number>;
    [...found.axes].slice(0, 3).forEach((axis: string, at: number) => {
      middle[axis] = (found.min_mm[at] + found.max_mm[at]) / 2;
    });
    await bench.command('GoTo', { system: 'Machine', position: middle });
    await expect.poll(async () => (await bench.position())[0], { timeout: 20_000 }).toBeCloseTo(middle.X, 1);
    await expect(stateWord(page)).toContainText('Idle');
    await hold(page, 'Zero all axes');
    await expect.poll(async () => (await bench.state()).snapshot.work_position_mm).toEqual([0, 0, 0]);

    // Load, read the check, start, hold, override, go on, to the end.
    await page.getByRole('link', { name: 'Jobs' }).click();
    await page.locator('input[type=file]').setInputFiles({ name: 'part.nc', mimeType: 'text/plain', buffer: Buffer.from(zigzag(60)) });
    await expect(page.getByText('On the machine')).toBeVisible();
    await expect(page.getByTestId('check').first()).toBeVisible();
    await page.getByRole('link', { name: 'Control' }).click();
    await expect(page.getByTestId('program-list')).toContainText('G21 G90 G94');
    const bar = page.getByTestId('job-bar');
    await hold(page, 'Start', bar);
    await expect(stateWord(page)).toContainText('Running');
    await page.getByRole('button', { name: 'Feed more' }).click();
    await expect.poll(async () => (await bench.state()).snapshot.overrides?.feed).toBe(110);
    await bar.getByRole('button', { name: 'Hold' }).click();
    await expect.poll(async () => (await bench.state()).job.phase).toBe('Held');
    await expect(stateWord(page)).toContainText(/Hold|Held/);
    const held = await bench.position();
    await page.waitForTimeout(500);
    expect(await bench.position()).toEqual(held);
    await bar.getByRole('button', { name: 'Resume' }).first().click();
    await page.waitForTimeout(200);
    if (!(await stateWord(page).textContent())?.includes('Running')) await hold(page, 'Resume', bar);
    await expect(stateWord(page)).toContainText('Running');
    await expect.poll(async () => (await bench.state()).job?.phase, { timeout: 60_000 }).toBe('Finished');
    await expect(stateWord(page)).toContainText('Idle');
  });
}

test('Stop acts within 100 ms, whatever the page does', async ({ page, bench }) => {
  await bench.start('grblhal', '1');
  await bench.upload('part.nc', zigzag(100));
  await page.goto(bench.url);
  await expect(stateWord(page)).toContainText(/Idle|Alarm/);
  await page.getByTestId('jog-pad').getByRole('button', { name: 'Jog X+', exact: true }).hover();
  const times = await page.evaluate(async () => {
    const spent: number[] = [];
    const send = WebSocket.prototype.send;
    let sent = 0;
    WebSocket.prototype.send = function (text) {
      if (String(text).includes('"Stop"')) sent = performance.now();
      return send.call(this, text);
    };
    const stop = document.querySelector<HTMLElement>('[data-testid=stop]')!;
    const target = stop.matches('button') ? stop : stop.querySelector('button')!;
    const end = performance.now() + 20;
    for (let i = 0; i < 5; ++i) {
      while (performance.now() < end + i * 20);
      const pressed = performance.now();
      target.dispatchEvent(new PointerEvent('pointerdown', { bubbles: true, button: 0 }));
      target.click();
      await new Promise((resolve) => setTimeout(resolve, 150));
      spent.push(sent - pressed);
    }
    return spent;
  });
  for (const spent of times) expect(spent).toBeLessThan(100);
});
