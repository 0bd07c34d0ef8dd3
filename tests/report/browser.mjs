// A browser for the tests: Debian's chromium driven by playwright-core, both of them optional.
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';

export const skipped = 77;
const program = '/usr/bin/chromium';
const firefox = '/usr/bin/firefox-esr';
const quiet = [
  '--headless',
  '--no-sandbox',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
  '--disable-quic',
];

/** What is missing to run a browser; nothing where all is there. */
export function missing() {
  if (!existsSync(program)) return 'chromium is missing (scripts/setup test installs it)';
  try {
    driver();
  } catch {
    return 'playwright-core is missing (npm ci in report/ installs it)';
  }
  return null;
}

const playwright = () => createRequire(new URL('../../report/package.json', import.meta.url))('playwright-core');
const driver = () => playwright().chromium;

/** As missing(), of Firefox. */
export function missingFirefox() {
  if (!existsSync(firefox)) return 'Firefox is missing (apt-get install firefox-esr)';
  try {
    playwright();
  } catch {
    return 'playwright-core is missing (npm ci in report/ installs it)';
  }
  return null;
}

/** Debian's own, by WebDriver BiDi. It tells of no download. @param {string} downloadsPath folder for files that are saved */
export const launchFirefox = (downloadsPath) =>
  playwright().firefox.launch({ channel: 'moz-firefox', executablePath: firefox, headless: true, downloadsPath });

/** @param {{webgl: boolean}} options */
export const launch = ({ webgl }) =>
  driver().launch({
    executablePath: program,
    args: [
      ...quiet,
      ...(webgl ? ['--use-angle=swiftshader', '--enable-unsafe-swiftshader'] : ['--disable-3d-apis', '--disable-gpu']),
    ],
  });

/**
 * Opens a page as a double click does and keeps a list of what must not happen: messages, errors, requests.
 * @param {any} browser @param {string} file @param {object} [options] of the page
 */
export async function open(browser, file, options = {}) {
  const page = await browser.newPage({
    viewport: { width: 1280, height: 900 },
    colorScheme: 'light',
    reducedMotion: 'reduce',
    ...options,
  });
  // Software rendering on a busy machine takes its time.
  page.setDefaultTimeout(240_000);
  const complaints = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('request', (request) => {
    if (!request.isNavigationRequest() && !/^(data|blob):/.test(request.url()))
      complaints.push(`request of ${request.url()}`);
  });
  await page.goto(`file://${file}`);
  await page.waitForSelector('#reproduce');
  await page.waitForTimeout(300);
  return { page, complaints };
}
