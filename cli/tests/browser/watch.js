// First in the page: what goes wrong while it loads.
window.faults = [];
window.addEventListener("error", (event) => faults.push(`console: ${event.message}`));
window.addEventListener("unhandledrejection", (event) => faults.push(`console: ${event.reason}`));
