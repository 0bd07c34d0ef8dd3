MODULE Rail
  ! Äußere Achse in mm
  CONST jointtarget jA:=[[0,0,0,0,30,0],[1250.5,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    ActUnit TRACK;
    MoveAbsJ jA\NoEOffs,v100,fine,tool0;
  ENDPROC
ENDMODULE
