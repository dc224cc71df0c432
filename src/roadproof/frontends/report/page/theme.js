// Before anything is drawn: the colours of the system's choice, light or dark.
const wanted = matchMedia("(prefers-color-scheme: dark)");
const choose = () => { document.documentElement.dataset.theme = wanted.matches ? "dark" : "light"; };
choose();
wanted.addEventListener("change", choose);
