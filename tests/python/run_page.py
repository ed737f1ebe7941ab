"""Runs the Python of a page in docs, block after block, in one namespace.

    run_page.py FOLDER_OF_neve.py PAGE
"""

import re
import sys

sys.path.insert(0, sys.argv[1])
blocks = re.findall(r"^```python\n(.*?)^```", open(sys.argv[2]).read(), re.DOTALL | re.MULTILINE)
assert len(blocks) >= 5, len(blocks)
names = {}
for block in blocks:
    print(block.splitlines()[0])
    exec(compile(block, sys.argv[2], "exec"), names)
print("done")
