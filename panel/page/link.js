// The link to the server: actions one after the other, each with the revision that was seen, and the stream of news.

export class Link {
  constructor(onFrame, onConnection) {
    this.onFrame = onFrame;
    this.onConnection = onConnection;
    this.revision = 0;
    this.queue = Promise.resolve();
  }

  async begin() {
    const answer = await fetch("/state");
    if (!answer.ok) throw new Error(await answer.text());
    const first = await answer.json();
    this.revision = first.state.revision;
    this.watch();
    return first;
  }

  watch() {
    const socket = new WebSocket(`ws://${location.host}/watch`);
    socket.onopen = () => this.onConnection(true);
    socket.onmessage = (event) => {
      const frame = JSON.parse(event.data);
      if (frame.state) this.revision = Math.max(this.revision, frame.state.revision);
      this.onFrame(frame);
    };
    socket.onclose = () => {
      this.onConnection(false);
      setTimeout(() => this.watch(), 1000);
    };
  }

  // The answer's refusal in words, or null.
  do(action) {
    const done = this.queue.then(() => this.send(action));
    this.queue = done.catch(() => null);
    return done;
  }

  async send(action) {
    let answer;
    try {
      answer = await fetch("/do", { method: "POST", body: JSON.stringify({ seen: this.revision, ...action }) });
    } catch {
      return "the server does not answer; what is set is kept, start it again with morfax panel";
    }
    const said = await answer.json().catch(() => ({ refused: `the server answers ${answer.status}` }));
    if (said.revision) this.revision = Math.max(this.revision, said.revision); // news may have come before
    return said.refused ?? null;
  }

  // A card, settings or a machine of the operator's own; `option`: what it is to be, or "any".
  async own(file, option) {
    const answer = await fetch(`/own/${option.replace(/^--/, "")}/${encodeURIComponent(file.name)}`, { method: "POST", body: file });
    const said = await answer.json().catch(() => ({ refused: `the server answers ${answer.status}` }));
    if (said.refused) return said.refused;
    return this.do({ do: "set", option: said.option, value: said.name });
  }

  async upload(file) {
    const answer = await fetch(`/upload/${encodeURIComponent(file.name)}`, { method: "POST", body: file });
    const said = await answer.json().catch(() => ({ refused: `the server answers ${answer.status}` }));
    if (said.refused) return said.refused;
    return this.do({ do: "open", drawing: said.drawing });
  }
}
