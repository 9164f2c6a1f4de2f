"""Writing with a pen: letters as strokes, the program that draws them, and the drawing compared with the letters."""
