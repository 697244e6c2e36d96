(function () {
  var circuits = @circuits@;
  var root = document.currentScript ? document.currentScript.closest("svg") : document.documentElement;
  var parts = root.querySelectorAll("[data-owner]");
  function light(names) {
    parts.forEach(function (part) {
      var lit = !names || names.indexOf(part.getAttribute("data-owner")) >= 0;
      part.style.opacity = lit ? "" : "0.15";
    });
  }
  function circuit(name) {
    if (circuits[name]) { return circuits[name]; }
    for (var key in circuits) { if (circuits[key].indexOf(name) >= 0) { return circuits[key]; } }
    return null;
  }
  parts.forEach(function (part) {
    part.addEventListener("mouseenter", function () { light(circuit(part.getAttribute("data-owner"))); });
    part.addEventListener("mouseleave", function () { light(null); });
  });
})();
