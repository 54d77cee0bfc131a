"""`python -m culbuto` and the `culbuto` command."""

from culbuto.cli import main

if __name__ == "__main__":
    main(prog_name="culbuto")
