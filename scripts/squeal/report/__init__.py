"""The page that scripts/report writes. What each module holds: markup elements of HTML and tables, charts pictures of
lines and points as SVG, shapes bodies for the viewer, words the scene in sentences, modes, statics, sweeps, transients,
amplitudes, responses and vibrations the sections of each analysis, origin errors, cost and commands, compare several folders side
by side, page all of it in one file. page.css, page.js and viewer.js go into the file as they are."""
