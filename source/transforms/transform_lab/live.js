// Carries messages between the kernel and the pages that show one scene. It runs for as long as the kernel's side lives.
export default {
  initialize({model}) {
    const scene = model.get("scene"), pages = new Set();
    const listen = ({data, source}) => {
      if (data?.scene !== scene || data.from !== "page") return;
      pages.add(source);
      model.send(data.message);
    };
    const tell = (page, message, buffers = []) => {
      const packets = buffers[0]?.buffer.slice(buffers[0].byteOffset, buffers[0].byteOffset + buffers[0].byteLength);
      page.postMessage({scene, from: "kernel", message, packets}, "*");
    };
    window.addEventListener("message", listen);
    model.on("msg:custom", (message, buffers) => {
      for (const page of pages) page.closed ? pages.delete(page) : tell(page, message, buffers);
    });
    for (const frame of document.querySelectorAll("iframe")) tell(frame.contentWindow, {hello: true});
    return () => window.removeEventListener("message", listen);
  },
};
