#!/usr/bin/env bash
# Surprise: nh3==0.3.8: with two attributes of a tag in set_tag_attribute_values, their order in the cleaned HTML differs from
# process to process, so pages made of the same text are not the same bytes.
# Guess: the order of the dictionary, or of the alphabet.
# Seen: in 40 processes with PYTHONHASHSEED=0 both <input disabled="" type="checkbox"> and the other way round.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check nh3==0.3.8
for _ in $(seq 40); do
  PYTHONHASHSEED=0 venv/bin/python -c '
import nh3
print(nh3.clean("<input>", tags={"input"}, set_tag_attribute_values={"input": {"type": "checkbox", "disabled": ""}}))'
done | sort | uniq -c | tee seen
if [ "$(wc -l < seen)" != 2 ]; then
  echo "nh3 now has one order."
  exit 1
fi
