/PROG  REGISTERS
/ATTR
OWNER		= MNEDITOR;
COMMENT		= "";
LINE_COUNT	= 10;
TCD:  STACK_SIZE	= 0;
DEFAULT_GROUP	= 1,*,*,*,*;
/MN
   1:  R[1]=1    ;
   2:  LBL[1]    ;
   3:J P[R[1]] 50% FINE    ;
   4:J PR[1] 50% FINE    ;
   5:  PR[2]=P[2]    ;
   6:  PR[2,3]=PR[2,3]+50    ;
   7:L PR[2] 100mm/sec FINE    ;
   8:  R[1]=R[1]+1    ;
   9:  IF R[1]<=2,JMP LBL[1]    ;
  10:J P[2] 10% FINE    ;
/POS
P[1]{
   GP1:
	UF : 0, UT : 1,	
	J1=    10.000 deg,	J2=   -20.000 deg,	J3=    30.000 deg,
	J4=     0.000 deg,	J5=   -45.000 deg,	J6=     5.000 deg
};
P[2]{
   GP1:
	UF : 0, UT : 1,	
	J1=    10.000 deg,	J2=   -20.000 deg,	J3=    30.000 deg,
	J4=     0.000 deg,	J5=   -45.000 deg,	J6=     5.000 deg
};
/END
