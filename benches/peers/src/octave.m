% Octave's lsqnonlin as a service: reads bounds and a start, fits, says that it is done, and so on to the end of its input.
% All numbers are doubles. A fit comes as rows, lower, upper and start; what it asks for goes out as nargout and x; done are -1, iterations and zeros.
1;

% Residuals and, where they are wanted, the Jacobian: what MATLAB's lsqnonlin calls with SpecifyObjectiveGradient.
function [residuals, jacobian] = ask (x, rows)
  fwrite (stdout, [nargout; x(:)], "double");
  fflush (stdout);
  columns = 1 + 6 * (nargout == 2);
  answer = fread (stdin, 1 + rows * columns, "double");
  if (! answer(1))
    error ("race:over", "the race is over");
  endif
  residuals = answer(2:1+rows);
  jacobian = reshape (answer(2+rows:end), rows, []);
endfunction

% A race that is cut off leaves no file behind.
crash_dumps_octave_core (false);
warning ("off", "Octave:shadowed-function");
pkg load optim
optim = pkg ("describe", "optim"){1};
printf ("%s %s\n", OCTAVE_VERSION, optim.version);
fflush (stdout);
options = optimset ("Jacobian", "on");
while (numel (task = fread (stdin, 19, "double")) == 19)
  iterations = 0;
  try
    [~, ~, ~, ~, output] = lsqnonlin (@(x) ask (x, task(1)), task(14:19), task(2:7), task(8:13), options);
    iterations = output.niter;
  catch failure
    if (! strcmp (failure.identifier, "race:over"))
      fprintf (stderr, "lsqnonlin: %s\n", failure.message);
    endif
    iterations = -1;
  end_try_catch
  fwrite (stdout, [-1; iterations; zeros(5, 1)], "double");
  fflush (stdout);
endwhile
