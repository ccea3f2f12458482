"""The page in the browser, by viser (extra ``view``): replay of a record, and live control."""
