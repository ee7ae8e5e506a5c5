// Settings to begin with, each as the address of its view.

import { element, make } from "./dom.js";

/** Name and address of each. */
const PRESETS = [
  ["Velocity control, the letter's Fig. 2(a)", "v=1"],
  [
    "Load control, the letter's Fig. 2(b)",
    "v=1&control=load&x=alpha_n,-8,1&y=tau,0,12&mu_prime=-0.5&at=-2.5,1",
  ],
  [
    "A motion under control, the letter's Fig. 3(a)",
    "v=1&x=alpha_v,-1,0.2&y=tau,0,12&law=weakening&mu0=0.5&v_s=0.5&v0=0.35&at=-0.33,4.15&start=0.3535,0",
  ],
  [
    "A rig in N, m, s, with a Stribeck law",
    "v=1&control=load&x=alpha_n,-9000,2000&y=tau,0,0.3&law=stribeck&units=N,m,s&mass=2&stiffness=500" +
      "&normal_load=30&v0=0.1&mu0=0.33&v_s=0.062&mu_s=0.52&at=-5000,0.03",
  ],
  ["Turning: lobes of chatter", "v=1&model=turning&x=tau,1,20&y=turning-width,0,0.6&at=7,0.03"],
  [
    "An upright pendulum, balanced with a delay",
    "v=1&model=pd&x=pd-k_p,0,4&y=pd-k_d,0,4&pd-stiffness=-1&tau=0.3&at=1.6,1.2",
  ],
];

/**
 * Fills the list of presets.
 * @param {(address: string) => void} chosen
 */
export function offerPresets(chosen) {
  const select = element("preset");
  const options = PRESETS.map(([text], i) => make("option", { value: i }, text));
  select.append(make("option", { value: "" }, "…"), ...options);
  select.addEventListener("change", () => {
    const [, address] = PRESETS[select.value] ?? [];
    select.value = "";
    if (address) chosen(address);
  });
}
