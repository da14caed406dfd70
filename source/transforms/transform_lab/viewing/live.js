// Carries messages between the kernel and the pages that show its scenes. It runs for as long as the kernel's side lives.
export default {
  initialize({model}) {
    const pages = new Map();  // of each scene, by its name
    const tell = (page, message, packets) => page.postMessage({from: "kernel", message, packets}, "*");
    const listen = ({data, source}) => {
      if (data?.from !== "page") return;
      const {scene} = data.message;
      pages.set(scene, (pages.get(scene) ?? new Set()).add(source));
      model.send(data.message);
    };
    window.addEventListener("message", listen);
    model.on("msg:custom", (message, [packed]) => {
      const packets = packed.buffer.slice(packed.byteOffset, packed.byteOffset + packed.byteLength);
      const open = pages.get(message.scene);
      open?.forEach(page => page.closed ? open.delete(page) : tell(page, message, packets));
    });
    for (const frame of document.querySelectorAll("iframe")) tell(frame.contentWindow, {hello: true});
    return () => window.removeEventListener("message", listen);
  },
};
