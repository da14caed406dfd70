// Turns a place for a prediction into fields or buttons, and says what an answer is worth.
{
  const makePlace = form => {
    const {right, wrong, ask, names} = JSON.parse(form.dataset.predict), said = document.createElement("output");
    Object.assign(said.style, {marginLeft: "8px", whiteSpace: "pre-wrap"});
    said.setAttribute("aria-live", "polite");
    const say = (good, words) => {
      said.style.borderLeft = `4px solid ${good ? "#1b7837" : "#d9690f"}`;
      said.style.paddingLeft = "8px";
      said.textContent = `${good ? "✓" : "✗"} ${words}`;
    };
    const button = text => Object.assign(document.createElement("button"), {type: "button", textContent: text});
    const yes = "Yes. Read on: is it your reason, too?", no = "Not yet. Look again, or read on.";
    Object.assign(form.style, {display: "flex", flexWrap: "wrap", gap: "6px", alignItems: "baseline", margin: "4px 0"});
    form.onsubmit = () => false;
    if (typeof right === "string") {
      const choices = [right, ...wrong.map(([given]) => given)].sort((a, b) => a.localeCompare(b, "en", {numeric: true}));
      form.replaceChildren(`${ask}:`, ...choices.map(choice => {
        const made = button(choice);
        made.onclick = () => {
          for (const other of form.querySelectorAll("button")) other.setAttribute("aria-pressed", other === made);
          choice === right ? say(true, yes) : say(false, new Map(wrong).get(choice));
        };
        return made;
      }), said);
      return;
    }
    // 0.5, 0,5 and 1/2 are the same, and a minus may be typed or copied from the text.
    const number = text => {
      const plain = text.replace(/\s/g, "").replace("−", "-").replaceAll(",", ".");
      const [, top, , below] = plain.match(/^(-?\d*\.?\d+)(\/(\d*\.?\d+))?°?$/) ?? [];
      return top === undefined ? NaN : top / (below ?? 1);
    };
    const close = (one, other) => Math.abs(one - other) <= 0.01001 * Math.max(1, Math.abs(other));
    if (right.length === 1) names[0] = "";
    const fields = right.map((_, i) => {
      const field = Object.assign(document.createElement("input"), {size: 6, autocomplete: "off", inputMode: "text"});
      field.setAttribute("aria-label", names[i] || ask);
      field.style.font = "inherit";
      return field;
    });
    const tell = Object.assign(button("Is it so?"), {type: "submit"});  // so that Enter in any field is a click on it
    tell.onclick = () => {
      const given = fields.map(field => number(field.value)), good = given.map((value, i) => close(value, right[i]));
      const found = names.filter((name, i) => name && good[i]);
      const unread = given.findIndex(Number.isNaN);
      const known = wrong.find(([numbers]) => numbers.every((value, i) => close(given[i], value)));
      if (unread >= 0) say(false, `Write a number${names[unread] && ` for ${names[unread]}`}, such as -0.5.`);
      else if (good.every(Boolean)) say(true, yes);
      else if (known) say(false, known[1]);
      else if (found.length) say(false, `${found.join(" and ")} ${found.length > 1 ? "are" : "is"} right, the rest is not yet.`);
      else say(false, no);
      return false;
    };
    form.replaceChildren(`${ask}:`, ...fields.flatMap((field, i) => names[i] ? [names[i], field] : [field]), tell, said);
  };
  const waiting = window.transformLabPredictions ?? [];
  window.transformLabPredictions = {push: makePlace, forEach: () => {}};
  waiting.forEach(makePlace);
}
