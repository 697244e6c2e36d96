// The page of a motion: waits for its data, which the bench sends, and then starts dofkit's player.
addEventListener("message", ({ origin, data }) => {
  if (origin !== location.origin || document.querySelector("script[src='player.js']")) return;
  document.getElementById("data").textContent = JSON.stringify(data.data);
  document.querySelector("canvas").setAttribute("aria-label", data.alternative);
  for (const note of data.notes) {
    document.getElementById("notes").append(Object.assign(document.createElement("p"), { textContent: note }));
  }
  const player = document.createElement("script");
  player.src = "player.js";
  document.head.append(player);
});
parent.postMessage("player", location.origin);
