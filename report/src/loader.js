// Unpacks the page's script and runs it: packed it has two fifths of its size.
(async () => {
  try {
    const packed = document.getElementById('report-script').textContent;
    const bytes = Uint8Array.from(atob(packed), (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    const script = document.createElement('script');
    script.textContent = await new Response(stream).text();
    document.body.append(script);
  } catch (error) {
    document.getElementById('page').textContent = `This report needs a browser of 2023 or later: ${error.message}.`;
  }
})();
